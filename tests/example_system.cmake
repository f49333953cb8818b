# Builds tools/example_system and runs its systems in 2-D and in 3-D. In: see example.cmake, and SCENES.

include(${CMAKE_CURRENT_LIST_DIR}/example.cmake)

function(expect_systems folder)
  file(READ ${folder}/summary.json summary)
  foreach(system mean_height log_mean_height)
    if(NOT summary MATCHES "\"${system}\"")
      message(FATAL_ERROR "summary.json does not know the system ${system}:\n${summary}")
    endif()
  endforeach()
endfunction()

set(program ${WORK}/build/example_system)
run(${program} run ${EXAMPLE}/scene.json --steps 5 --out ${WORK}/plane)
expect_systems(${WORK}/plane)

set(systems [=[[{"use": "mean_height", "after": "g2p"}, {"use": "log_mean_height", "after": "g2p"}]]=])
run(${program} run ${SCENES}/hydrostatic_3d.json --steps 2 --out ${WORK}/space --set "/systems=${systems}")
expect_systems(${WORK}/space)
