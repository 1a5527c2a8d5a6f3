# Runs after everything is installed: documents link to files as they lie in the project; what lies
# elsewhere below a prefix is linked there.
set(abut_documents "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/share/doc/abut")
set(abut_places  # in the project, and from share/doc/abut
  "configs" "../../abut/configs"
  "studies" "../../abut/studies"
  "proto/abut/" "../../abut/proto/abut/"
  "sdk/python/" "../../abut/python/"
  "sdk/include/" "../../../include/"
  "contract" "../../../include/abut/contract"
  "messaging" "../../../include/abut/messaging"
  "LICENSE" "copyright")
file(GLOB_RECURSE abut_names RELATIVE "${abut_documents}" "${abut_documents}/*.md")
foreach(name IN LISTS abut_names)
  get_filename_component(folder "${name}" DIRECTORY)
  string(REGEX REPLACE "[^/]+" ".." up "${folder}")
  if(up)
    string(APPEND up "/")
  endif()
  file(READ "${abut_documents}/${name}" before)
  set(text "${before}")
  set(places ${abut_places})
  while(places)
    list(POP_FRONT places from to)
    string(REPLACE "](${up}${from}" "](${up}${to}" text "${text}")
  endwhile()
  if(folder STREQUAL "proto")
    string(REPLACE "](abut/" "](../../../abut/proto/abut/" text "${text}")
  endif()
  if(NOT text STREQUAL before)
    file(WRITE "${abut_documents}/${name}" "${text}")
  endif()
endforeach()
