# Installs minamo into a folder of its own and runs a scene with the installed program.
# In: MINAMO_BUILD, SCENES, PREFIX.

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${PREFIX})
run(${CMAKE_COMMAND} --install ${MINAMO_BUILD} --prefix ${PREFIX})
run(${CMAKE_COMMAND} -E compare_files ${SCENES}/../LICENSE ${PREFIX}/share/doc/minamo/LICENSE)
run(${PREFIX}/bin/minamo --version)
run(${PREFIX}/bin/minamo run ${SCENES}/dam_break.json --steps 3 --out ${PREFIX}/out)
