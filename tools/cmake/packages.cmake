# What minamo is built on. The build and the installed package (minamoConfig.cmake) both read this file.

find_package(TBB REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(spdlog REQUIRED)
find_package(muparser REQUIRED)
if(PROJECT_NAME STREQUAL "minamo")
  find_package(CLI11 REQUIRED)  # headers only, and used in sources only
endif()

# Imported target NAME from HEADER and LIBRARIES, for packages that Debian 12 ships without a CMake configuration.
# SUFFIXES are folders under the usual include and library folders, looked into first.
function(minamo_import name header)
  cmake_parse_arguments(PARSE_ARGV 2 arg "" "" "LIBRARIES;SUFFIXES")
  if(TARGET minamo::${name})
    return()
  endif()
  add_library(minamo::${name} INTERFACE IMPORTED)
  if(header)
    find_path(minamo_${name}_include ${header} PATH_SUFFIXES ${arg_SUFFIXES} REQUIRED)
    target_include_directories(minamo::${name} SYSTEM INTERFACE ${minamo_${name}_include})
    mark_as_advanced(minamo_${name}_include)
  endif()
  foreach(library IN LISTS arg_LIBRARIES)
    find_library(minamo_${library}_library ${library} PATH_SUFFIXES ${arg_SUFFIXES} REQUIRED)
    target_link_libraries(minamo::${name} INTERFACE ${minamo_${library}_library})
    mark_as_advanced(minamo_${library}_library)
  endforeach()
endfunction()

# BLAS and LAPACK. Threads are TBB's business, so a serial OpenBLAS is taken where there is one. SuiteSparse asks for
# libblas.so.3, and that for libopenblas.so.0, by name only, and Debian may have pointed these names to another BLAS.
# As direct dependencies of the program, which it keeps even if it calls nothing of theirs, they are loaded first.
find_library(minamo_openblas_serial NAMES openblas libopenblas.so.0
  PATHS /usr/lib PATH_SUFFIXES ${CMAKE_LIBRARY_ARCHITECTURE}/openblas-serial openblas-serial NO_DEFAULT_PATH)
mark_as_advanced(minamo_openblas_serial)
if(NOT TARGET minamo::blas AND minamo_openblas_serial)
  get_filename_component(minamo_blas_folder ${minamo_openblas_serial} DIRECTORY)
  set(minamo_blas_libraries
    ${minamo_blas_folder}/libblas.so.3 ${minamo_blas_folder}/liblapack.so.3 ${minamo_openblas_serial})
  list(JOIN minamo_blas_libraries "," minamo_blas_kept)
  add_library(minamo::blas INTERFACE IMPORTED)
  # Twice: once to keep them, once as files, from which CMake learns the folder to look into at run time.
  target_link_libraries(minamo::blas INTERFACE
    "-Wl,--push-state,--no-as-needed,${minamo_blas_kept},--pop-state" ${minamo_blas_libraries})
elseif(NOT TARGET minamo::blas)
  minamo_import(blas "" LIBRARIES lapack blas)
endif()

minamo_import(suitesparse umfpack.h LIBRARIES umfpack cholmod suitesparseconfig SUFFIXES suitesparse)
# CHOLMOD runs on the compiler's OpenMP, which is told to keep to one thread.
target_link_libraries(minamo::suitesparse INTERFACE minamo::blas gomp)
if(MINAMO_OPENVDB)
  minamo_import(openvdb openvdb/openvdb.h LIBRARIES openvdb)
  set(minamo_openvdb minamo::openvdb)
endif()
minamo_import(hdf5 hdf5.h LIBRARIES hdf5 SUFFIXES hdf5/serial)
minamo_import(zlib zlib.h LIBRARIES z)

# Debian's HDF5 can also read from the web. Its shared library brings curl, TLS and Kerberos along, 30 libraries, whose
# loading takes a quarter of the processor time of a run of one step. So programs take their part of the static library
# where there is one. What is loaded into others, such as the Python module, cannot: its code has fixed places.
set(minamo_hdf5_parts "")
find_library(minamo_hdf5_static NAMES libhdf5.a PATH_SUFFIXES hdf5/serial)
foreach(part sz aec z)
  find_library(minamo_${part}_static NAMES lib${part}.a)
  list(APPEND minamo_hdf5_parts ${minamo_${part}_static})
  mark_as_advanced(minamo_${part}_static)
endforeach()
mark_as_advanced(minamo_hdf5_static)
if(minamo_hdf5_static AND NOT "${minamo_hdf5_parts}" MATCHES "NOTFOUND")
  set(minamo_is_program $<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>)
  set(minamo_hdf5_libraries "$<$<NOT:${minamo_is_program}>:${minamo_hdf5_library}>")
  foreach(library ${minamo_hdf5_static} ${minamo_hdf5_parts} dl)
    list(APPEND minamo_hdf5_libraries "$<${minamo_is_program}:${library}>")
  endforeach()
  set_property(TARGET minamo::hdf5 PROPERTY INTERFACE_LINK_LIBRARIES ${minamo_hdf5_libraries})
endif()
