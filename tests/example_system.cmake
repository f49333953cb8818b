# Installs minamo into a folder of its own, builds tools/example_system against it there, as a user would, and runs it.
# In: MINAMO_BUILD, EXAMPLE, WORK, GENERATOR, BUILD_TYPE.

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${MINAMO_BUILD} --prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} -S ${EXAMPLE} -B ${WORK}/build -G ${GENERATOR}
  -D CMAKE_BUILD_TYPE=${BUILD_TYPE} -D CMAKE_PREFIX_PATH=${WORK}/prefix)
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/build/example_system run ${EXAMPLE}/scene.json --steps 5 --out ${WORK}/out)

file(READ ${WORK}/out/summary.json summary)
foreach(system mean_height log_mean_height)
  if(NOT summary MATCHES "\"${system}\"")
    message(FATAL_ERROR "summary.json does not know the system ${system}:\n${summary}")
  endif()
endforeach()
