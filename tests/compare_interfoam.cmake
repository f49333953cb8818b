# Runs the first steps of a scene and compares them with tools/compare_interfoam.py, as a user would.
# In: PYTHON, PROGRAM, SOURCE, WORK.

file(REMOVE_RECURSE ${WORK})
execute_process(COMMAND ${PROGRAM} run ${SOURCE}/scenes/dam_break.json --set /time/end=0.1
  --out ${WORK}/dam_break --quiet COMMAND_ERROR_IS_FATAL ANY)

execute_process(COMMAND ${PYTHON} ${SOURCE}/tools/compare_interfoam.py ${WORK}/dam_break
  OUTPUT_VARIABLE distances COMMAND_ERROR_IS_FATAL ANY)
# 0.009 at 0.1 s, where interFoam on 40 x 40 cells is 0.008 from interFoam on 160 x 160.
if(NOT distances MATCHES "dam_break +0\\.0(08|09|10)")
  message(FATAL_ERROR "unexpected distance from interFoam:\n${distances}")
endif()
