# Option MINAMO_PYTHON and what it needs: a developer has the module where it can be built, a user asks for it. It is
# built for the distribution's python, which has NumPy, h5py and matplotlib from packages.

if((MINAMO_DEVELOPER OR MINAMO_PYTHON) AND NOT MINAMO_SANITIZE)
  if(NOT Python3_EXECUTABLE AND EXISTS /usr/bin/python3)
    set(Python3_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "The python that the module is built for")
  endif()
  find_package(Python3 QUIET COMPONENTS Interpreter Development.Module)
  if(Python3_FOUND)
    find_package(pybind11 2.10 QUIET)
  endif()
endif()
if(pybind11_FOUND)
  set(minamo_has_pybind11 ON)
else()
  set(minamo_has_pybind11 OFF)
endif()
option(MINAMO_PYTHON "Build the python module" ${minamo_has_pybind11})
if(MINAMO_PYTHON AND NOT minamo_has_pybind11)
  message(FATAL_ERROR "MINAMO_PYTHON needs the header files of python and pybind11 (python3-dev, pybind11-dev), and no "
    "sanitizer")
endif()
