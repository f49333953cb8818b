# The installable package: a user writes find_package(minamo), links minamo::minamo and includes <minamo/minamo.hpp>.

include(CMakePackageConfigHelpers)

set(minamo_headers ${CMAKE_INSTALL_INCLUDEDIR}/minamo)
set(minamo_package ${CMAKE_INSTALL_LIBDIR}/cmake/minamo)

# Components: program and python are what tools/package packs, development is the rest.
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME development)
install(TARGETS minamo_program COMPONENT program)
install(DIRECTORY scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/minamo COMPONENT program
  FILES_MATCHING PATTERN "*.json" PATTERN "README.md")
install(FILES README.md LICENSE tools/cmake/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
# Code of these is in the program or in the python module, and their licences are to come along. Debian has them here.
foreach(package libaec-dev libcli11-dev libeigen3-dev libfmt-dev libhdf5-dev libspdlog-dev libtbb-dev nlohmann-json3-dev
    pybind11-dev zlib1g-dev)
  install(FILES /usr/share/doc/${package}/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR}/packages RENAME ${package}
    COMPONENT program OPTIONAL)
endforeach()
install(TARGETS minamo EXPORT minamoTargets)
install(EXPORT minamoTargets NAMESPACE minamo:: DESTINATION ${minamo_package})
install(DIRECTORY engine components systems DESTINATION ${minamo_headers} FILES_MATCHING PATTERN "*.hpp")
install(FILES tools/program/minamo.hpp ${PROJECT_BINARY_DIR}/generated/minamo_version.hpp DESTINATION ${minamo_headers})

configure_package_config_file(tools/cmake/minamoConfig.cmake.in minamoConfig.cmake
  INSTALL_DESTINATION ${minamo_package})
write_basic_package_version_file(minamoConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/minamoConfig.cmake ${PROJECT_BINARY_DIR}/minamoConfigVersion.cmake
  tools/cmake/packages.cmake DESTINATION ${minamo_package})

# A Debian package and an archive, of the program and the python module.
set(CPACK_GENERATOR DEB TGZ)
set(CPACK_PACKAGE_NAME minamo)
set(CPACK_PACKAGE_CONTACT "minamo contributors <minamo@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program)
if(MINAMO_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_ARCHIVE_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
# Found in what the files link. The BLAS without threads lies in a folder of its own, which the program names.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS libopenblas0-serial)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3, python3-numpy, python3-h5py, python3-matplotlib")
include(CPack)
