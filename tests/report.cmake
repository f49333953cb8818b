# Runs the first steps of two scenes and shows them with tools/report and tools/compare_interfoam.py, as a user would.
# In: PYTHON, PROGRAM, SOURCE, WORK.

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

function(require_in file text)
  file(READ ${file} content)
  string(FIND "${content}" "${text}" place)
  if(place EQUAL -1)
    message(FATAL_ERROR "${file} does not say \"${text}\"")
  endif()
endfunction()

set(report ${PYTHON} ${SOURCE}/tools/report)
file(REMOVE_RECURSE ${WORK})
foreach(scene dam_break dam_break_flip)
  run(${PROGRAM} run ${SOURCE}/scenes/${scene}.json --set /time/end=0.1 --set /time/step=0.005
    --out ${WORK}/${scene} --quiet)
endforeach()
run(${PROGRAM} run ${SOURCE}/scenes/hydrostatic_3d.json --steps 1 --out ${WORK}/space --quiet)

foreach(name dam_break space)
  run(${report} ${WORK}/${name})
  foreach(text "data:image/png;base64," "Coloured by pressure" "Wall time of the systems")
    require_in(${WORK}/${name}/report.html ${text})
  endforeach()
endforeach()
run(${report} ${WORK}/dam_break ${WORK}/dam_break_flip --out ${WORK}/both.html)
require_in(${WORK}/both.html "Comparison: TPIC, FLIP")

execute_process(COMMAND ${PYTHON} ${SOURCE}/tools/compare_interfoam.py ${WORK}/dam_break
  OUTPUT_VARIABLE distances COMMAND_ERROR_IS_FATAL ANY)
# 0.012 at 0.1 s, where interFoam on 40 x 40 cells is 0.008 from interFoam on 160 x 160.
if(NOT distances MATCHES "dam_break +0\\.01")
  message(FATAL_ERROR "unexpected distance from interFoam:\n${distances}")
endif()

execute_process(COMMAND ${report} ${WORK}/nothing RESULT_VARIABLE status ERROR_VARIABLE message)
if(NOT status EQUAL 2 OR NOT message MATCHES "no results of minamo here")
  message(FATAL_ERROR "a folder without results: status ${status}, message \"${message}\"")
endif()
