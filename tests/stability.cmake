# Runs a case of tools/stability, has it judge a program that leaves garbage, and asks for a case that is not there.
# In: PYTHON, PROGRAM, SOURCE.

set(stability ${PYTHON} -B ${SOURCE}/tools/hard_cases)

include(${CMAKE_CURRENT_LIST_DIR}/support/require.cmake)

# All names of all sections are made for this, so every scene is at least built.
execute_process(COMMAND ${stability} --list OUTPUT_VARIABLE names COMMAND_ERROR_IS_FATAL ANY)
require_in("${names}" "  drops_cfl_2 ")

set(method --scheme pic --integrator midpoint --volume none)
execute_process(COMMAND ${stability} --program ${PROGRAM} lone_particle ${method} ERROR_VARIABLE said
  COMMAND_ERROR_IS_FATAL ANY)
if(NOT said MATCHES "^lone_particle, equal_order \\([0-9.]+ s\\)\nlone_particle, conforming \\([0-9.]+ s\\)\n$")
  message(FATAL_ERROR "a particle in free fall does not keep everything:\n${said}")
endif()

foreach(discretization equal_order conforming)
  execute_process(COMMAND ${stability} --program ${SOURCE}/tests/stability/garbage lone_particle ${method}
    --discretization ${discretization} ERROR_VARIABLE said COMMAND_ERROR_IS_FATAL ANY)
  if(NOT said MATCHES "^lone_particle, ${discretization} ")
    message(FATAL_ERROR "not with ${discretization} alone:\n${said}")
  endif()
  foreach(part "gave values that are not finite" "lost particles, 1 particles" "left the parabola" "in silence: pic with")
    require_in("${said}" "${part}")
  endforeach()
endforeach()

execute_process(COMMAND ${stability} drop_cfl_2 RESULT_VARIABLE status ERROR_VARIABLE message)
if(NOT status EQUAL 2)
  message(FATAL_ERROR "an unknown name: status ${status}")
endif()
require_in("${message}" "unknown name \"drop_cfl_2\"; nearest: drops_cfl_2")

execute_process(COMMAND ${stability} --discretization conforming --volume delta RESULT_VARIABLE status
  ERROR_VARIABLE message)
if(NOT status EQUAL 2)
  message(FATAL_ERROR "a volume correction that is not with a discretization: status ${status}")
endif()
require_in("${message}" "no volume correction \"delta\" with conforming; there are none, projection")

require_written_page(${PYTHON} ${SOURCE}/tools/hard_cases)
require_no_program(${stability} --program /nowhere/minamo lone_particle)
