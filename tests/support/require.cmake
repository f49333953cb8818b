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

# That RESULTS.md is what the python program in a folder writes of results.json.
function(require_written_page python folder)
  set(code "import runpy\nm = runpy.run_path('__main__.py')\nassert m['page'](m['load']()) == m['RESULTS'].read_text()")
  execute_process(COMMAND ${python} -B -c "${code}" WORKING_DIRECTORY ${folder} RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "RESULTS.md differs from the page of results.json by ${folder}")
  endif()
endfunction()
