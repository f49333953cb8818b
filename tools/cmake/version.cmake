# What `minamo --version` and summary.json tell of the build, in minamo_build.hpp. One source includes it, so that a new
# commit compiles no more than that.

set(minamo_compiler "${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}")

string(TOUPPER "${CMAKE_BUILD_TYPE}" minamo_configuration)
string(JOIN " " minamo_flags
  ${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${minamo_configuration}} ${minamo_public_options} ${minamo_private_options})

if(MINAMO_SANITIZE)
  string(APPEND minamo_flags " sanitizer: ${MINAMO_SANITIZE}")
endif()

# As they are given to CMake.
set(minamo_options "")
foreach(option PROCESSOR MPI PYTHON OPENVDB SANITIZE DEVELOPER)
  list(APPEND minamo_options "MINAMO_${option}=${MINAMO_${option}}")
endforeach()
string(JOIN " " minamo_options ${minamo_options})

# What -march=native means here.
set(minamo_processor "")
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  execute_process(COMMAND ${CMAKE_CXX_COMPILER} ${minamo_public_options} -Q --help=target
    OUTPUT_VARIABLE minamo_target_options ERROR_QUIET)
  set(minamo_target "-march=[\t ]+([^\n\t ]+)[\t ]*\n")
else()
  execute_process(COMMAND ${CMAKE_CXX_COMPILER} ${minamo_public_options} "-###" -E -x c++ /dev/null
    ERROR_VARIABLE minamo_target_options OUTPUT_QUIET)
  set(minamo_target "\"-target-cpu\" \"([^\"]+)\"")
endif()
if(minamo_target_options MATCHES "${minamo_target}")
  set(minamo_processor ${CMAKE_MATCH_1})
endif()

# The commit, if this folder itself is the checkout. The log of HEAD grows with every commit and checkout, and CMake runs
# anew when it does.
set(minamo_commit "")
find_package(Git QUIET)
if(Git_FOUND)
  execute_process(COMMAND ${GIT_EXECUTABLE} rev-parse --path-format=absolute --show-toplevel --git-path logs/HEAD HEAD
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE minamo_git RESULT_VARIABLE minamo_git_failed ERROR_QUIET)
  string(REGEX MATCHALL "[^\n]+" minamo_git "${minamo_git}")
  file(REAL_PATH ${PROJECT_SOURCE_DIR} minamo_source)
  if(NOT minamo_git_failed AND minamo_git MATCHES "^([^;]+);([^;]+);([0-9a-f]+)$" AND CMAKE_MATCH_1 STREQUAL minamo_source)
    set(minamo_commit ${CMAKE_MATCH_3})
    if(EXISTS ${CMAKE_MATCH_2})
      set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${CMAKE_MATCH_2})
    endif()
  endif()
endif()

configure_file(tools/cmake/version.hpp.in generated/minamo_version.hpp @ONLY)
configure_file(tools/cmake/build.hpp.in generated/minamo_build.hpp @ONLY)
