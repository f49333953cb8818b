# Runs a few steps of some benchmarks with the python part of tools/bench, and asks for one that is not there.
# In: PYTHON, BUILD (with the programs), SOURCE.

set(bench ${PYTHON} -B ${SOURCE}/tools/benchmarking --build ${BUILD})

include(${CMAKE_CURRENT_LIST_DIR}/support/require.cmake)

execute_process(COMMAND ${bench} --quick both_40_8ms both_large_1 both_large_2 solvers_40 size_40 size_80 assembly kernels
  OUTPUT_VARIABLE page COMMAND_ERROR_IS_FATAL ANY)
foreach(text "| 40 x 40, 8 ms, equal order | 1 | 800 | 792 | 3 |" "interFoam: ratio"
    "With conforming a step of the large tank is" "| 40 x 40, 2 x 2 |"
    "With conforming a step costs as (unknowns)^" "| viscosity_matrix |" "| block solve, ")
  require_in("${page}" "${text}")
endforeach()

# Three tries of two steps, of 2, 1 and 3 us: the second was taken back after its first system.
set(events "[{'name': name, 'ts': ts, 'dur': dur} for name, ts, dur in
  (('a', 0, 1), ('b', 1, 1), ('a', 10, 1), ('a', 12, 1), ('b', 13, 2))]")
execute_process(COMMAND ${PYTHON} -B -c "from measure import step_seconds; print(round(1e6 * step_seconds(${events}), 6))"
  WORKING_DIRECTORY ${SOURCE}/tools/benchmarking OUTPUT_VARIABLE microseconds COMMAND_ERROR_IS_FATAL ANY)
if(NOT microseconds STREQUAL "3.0\n")
  message(FATAL_ERROR "a step of 3 us measured as ${microseconds}")
endif()

execute_process(COMMAND ${bench} --list OUTPUT_VARIABLE names COMMAND_ERROR_IS_FATAL ANY)
require_in("${names}" "  space_32")

execute_process(COMMAND ${bench} solvrs RESULT_VARIABLE status ERROR_VARIABLE message)
if(NOT status EQUAL 2)
  message(FATAL_ERROR "an unknown name: status ${status}")
endif()
require_in("${message}" "unknown name \"solvrs\"; nearest: solvers")

require_written_page(${PYTHON} ${SOURCE}/tools/benchmarking)
require_no_program(${bench} --build /nowhere --quick size_40)
