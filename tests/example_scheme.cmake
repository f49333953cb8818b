# Builds tools/example_scheme and runs example_scheme_test.py on it. In: see example.cmake, and PYTHON.

include(${CMAKE_CURRENT_LIST_DIR}/example.cmake)
run(${PYTHON} ${CMAKE_CURRENT_LIST_DIR}/example_scheme_test.py ${WORK}/build/example_scheme ${EXAMPLE}/scene.json ${WORK})
