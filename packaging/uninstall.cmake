# Removes what `make install` has put below a prefix, and the folders that are empty then and that
# were made for it. Reads the list that stands there, so it needs no build folder.
#   [DESTDIR=DIR] cmake -Dprefix=DIR -P uninstall.cmake
set(root "$ENV{DESTDIR}${prefix}")
set(list "${root}/share/abut/installed.txt")
if(NOT EXISTS "${list}")
  message(FATAL_ERROR "There is no ${list}, so nothing below ${root} is known to be abut's. "
    "Say where it was installed, as make install was told: make uninstall PREFIX=DIR DESTDIR=DIR.")
endif()
file(STRINGS "${list}" names)
list(FILTER names EXCLUDE REGEX "\\.\\./")  # never above the prefix
set(folders ${names})
list(FILTER folders INCLUDE REGEX "/$")
list(TRANSFORM folders REPLACE "/$" "")
list(FILTER names EXCLUDE REGEX "/$")
foreach(name IN LISTS names)
  file(REMOVE "${root}/${name}")
  # A folder below one named abut is nobody else's.
  get_filename_component(folder "${name}" DIRECTORY)
  while(folder MATCHES "(^|/)abut(/|$)")
    list(APPEND folders "${folder}")
    get_filename_component(folder "${folder}" DIRECTORY)
  endwhile()
endforeach()

function(remove_empty folder)
  file(GLOB inside "${folder}/*" "${folder}/.*")
  list(FILTER inside EXCLUDE REGEX "/\\.+$")
  if(IS_DIRECTORY "${folder}" AND NOT inside)
    file(REMOVE_RECURSE "${folder}")
  endif()
endfunction()
list(FIND folders . made_for_it)  # the prefix itself: last
list(REMOVE_ITEM folders .)
list(REMOVE_DUPLICATES folders)
list(SORT folders ORDER DESCENDING)  # what is inside comes first
foreach(folder IN LISTS folders)
  remove_empty("${root}/${folder}")
endforeach()
if(made_for_it GREATER -1)
  remove_empty("${root}")
endif()
message(STATUS "removed from ${root}")
