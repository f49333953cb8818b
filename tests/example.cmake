# Builds a project that stands outside minamo against the installed package, as a user would.
# In: PREFIX, EXAMPLE, WORK, GENERATOR, BUILD_TYPE, and COMPILER, if not that of CMake's choice. Included by the scripts
# that run what was built.

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${WORK})
if(COMPILER)
  set(compiler -D CMAKE_CXX_COMPILER=${COMPILER})
endif()
run(${CMAKE_COMMAND} -S ${EXAMPLE} -B ${WORK}/build -G ${GENERATOR} ${compiler}
  -D CMAKE_BUILD_TYPE=${BUILD_TYPE} -D CMAKE_PREFIX_PATH=${PREFIX})
run(${CMAKE_COMMAND} --build ${WORK}/build)
