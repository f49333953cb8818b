# What the scripts that test tools/bench and tools/stability ask of their output.

function(require_in text part)
  string(FIND "${text}" "${part}" place)
  if(place EQUAL -1)
    message(FATAL_ERROR "no \"${part}\" in\n${text}")
  endif()
endfunction()

# Of a command whose program is /nowhere/minamo.
function(require_no_program)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status ERROR_VARIABLE message)
  if(NOT status EQUAL 1)
    message(FATAL_ERROR "no program: status ${status}")
  endif()
  require_in("${message}" "/nowhere/minamo: No such file or directory\n")
  require_in("${message}" " is as it was.")
endfunction()
