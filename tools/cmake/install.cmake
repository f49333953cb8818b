# The installable package: a user writes find_package(minamo), links minamo::minamo and includes <minamo/minamo.hpp>.

include(CMakePackageConfigHelpers)

set(minamo_headers ${CMAKE_INSTALL_INCLUDEDIR}/minamo)
set(minamo_package ${CMAKE_INSTALL_LIBDIR}/cmake/minamo)

install(TARGETS minamo_program)
install(TARGETS minamo EXPORT minamoTargets)
install(EXPORT minamoTargets NAMESPACE minamo:: DESTINATION ${minamo_package})
install(DIRECTORY engine components systems DESTINATION ${minamo_headers} FILES_MATCHING PATTERN "*.hpp")
install(FILES tools/minamo.hpp ${PROJECT_BINARY_DIR}/generated/minamo_version.hpp DESTINATION ${minamo_headers})

configure_package_config_file(tools/cmake/minamoConfig.cmake.in minamoConfig.cmake
  INSTALL_DESTINATION ${minamo_package})
write_basic_package_version_file(minamoConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/minamoConfig.cmake ${PROJECT_BINARY_DIR}/minamoConfigVersion.cmake
  tools/cmake/packages.cmake DESTINATION ${minamo_package})
