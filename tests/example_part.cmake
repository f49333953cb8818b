# Builds tools/example_part and asks the program for all that a key of one's own gives. In: see example.cmake, and SCENES.

include(${CMAKE_CURRENT_LIST_DIR}/example.cmake)

set(program ${WORK}/build/example_part)

# expect(TEXT ARGUMENT...): the program prints the text, or says it in an error.
function(expect text)
  execute_process(COMMAND ${program} ${ARGN} OUTPUT_VARIABLE out ERROR_VARIABLE out COMMAND_ECHO STDOUT)
  string(FIND "${out}" "${text}" place)
  if(place EQUAL -1)
    message(FATAL_ERROR "expected ${text} in:\n${out}")
  endif()
endfunction()

expect("wind           drag of the air on the surface" list parts)
expect("valid" check ${EXAMPLE}/scene.json)
expect("\"wind\"" schema)
expect("apply_wind" graph ${EXAMPLE}/scene.json)

file(READ ${EXAMPLE}/scene.json scene)
string(REPLACE "\"rate\"" "\"rates\"" misspelt "${scene}")
file(WRITE ${WORK}/misspelt.json "${misspelt}")
expect("/wind/rates" check ${WORK}/misspelt.json)
expect("closest   \"rate\"" check ${WORK}/misspelt.json)

# The wind moves the water, in 2-D and in 3-D; a scene that does not name it has no trace of it.
# last_momentum(FOLDER OUT): momentum_x of the last row.
function(last_momentum folder out)
  file(STRINGS ${folder}/history.csv rows)
  list(POP_BACK rows row)
  string(REPLACE "," ";" row "${row}")
  list(GET row 5 momentum)
  set(${out} ${momentum} PARENT_SCOPE)
endfunction()

run(${program} run ${EXAMPLE}/scene.json --steps 20 --out ${WORK}/plane)
last_momentum(${WORK}/plane plane)
if(NOT plane GREATER 1)
  message(FATAL_ERROR "the wind moves nothing: momentum_x = ${plane}")
endif()
file(READ ${WORK}/plane/summary.json summary)
if(NOT summary MATCHES "\"apply_wind\"")
  message(FATAL_ERROR "the profile does not know apply_wind:\n${summary}")
endif()
# What the wind gives is no gain of energy that nobody accounts for.
run(${program} run ${EXAMPLE}/scene.json --out ${WORK}/whole)
file(READ ${WORK}/whole/summary.json summary)
if(NOT summary MATCHES "\"warnings\": \\[\\]")
  message(FATAL_ERROR "the whole run warns:\n${summary}")
endif()
run(${program} run ${SCENES}/hydrostatic_3d.json --steps 2 --out ${WORK}/space
  --set "/wind={\"velocity\": [10, 0, 0], \"rate\": 1}")
execute_process(COMMAND ${program} graph ${SCENES}/dam_break.json OUTPUT_VARIABLE graph)
if(graph MATCHES "wind")
  message(FATAL_ERROR "a scene without wind has a trace of it")
endif()
