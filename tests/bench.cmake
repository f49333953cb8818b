# Runs a few steps of some benchmarks with the python part of tools/bench, and asks for one that is not there.
# In: PYTHON, BUILD (with the programs), SOURCE.

set(bench ${PYTHON} -B ${SOURCE}/tools/benchmarking --build ${BUILD})

function(require_in text part)
  string(FIND "${text}" "${part}" place)
  if(place EQUAL -1)
    message(FATAL_ERROR "no \"${part}\" in\n${text}")
  endif()
endfunction()

execute_process(COMMAND ${bench} --quick dam_break_40_8ms threads_250_steps solvers_40 size_40 size_80 assembly
  OUTPUT_VARIABLE page COMMAND_ERROR_IS_FATAL ANY)
foreach(text "| 40 x 40, 8 ms | 1 | 800 | 792 | 3 |" "interFoam: ratio"
    "times as fast as on one. Energies in history.csv are the same" "| 40 x 40, 2 x 2 |"
    "A step costs as (unknowns)^" "| viscosity_matrix |")
  require_in("${page}" "${text}")
endforeach()

execute_process(COMMAND ${bench} --list OUTPUT_VARIABLE names COMMAND_ERROR_IS_FATAL ANY)
require_in("${names}" "  space_32")

execute_process(COMMAND ${bench} solvrs RESULT_VARIABLE status ERROR_VARIABLE message)
if(NOT status EQUAL 2)
  message(FATAL_ERROR "an unknown name: status ${status}")
endif()
require_in("${message}" "unknown name \"solvrs\"; nearest: solvers")
