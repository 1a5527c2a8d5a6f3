# Most of what a file costs to compile is reading and instantiating the headers that its neighbours
# read too: several files of a target make one translation unit. Off in the presets of developers,
# where a file that leans on another's includes is to be found. What a unit needs: names in unnamed
# namespaces are a target's own (tests/tidy/units.py). A file costs up to
# a quarter less in units of 24 than in units of 8; the largest targets still have three units.
option(ABUT_UNITY "Compile several files of a target at once" OFF)
if(ABUT_UNITY)
  set(CMAKE_UNITY_BUILD ON)
  set(CMAKE_UNITY_BUILD_BATCH_SIZE 24)
endif()
