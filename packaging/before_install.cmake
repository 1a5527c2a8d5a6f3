# Runs before anything is installed: which of the folders that others use too are not there yet, so
# that uninstalling can take them away again, and which files an earlier installation has left.
# After it, packaging/after_install.cmake.
set(abut_root "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}")
set(abut_list "${abut_root}/share/abut/installed.txt")
set(abut_folders "")
set(abut_earlier "")
if(NOT CMAKE_INSTALL_COMPONENT)  # a part is for a package, whose system has lists of its own
  if(EXISTS "${abut_list}")
    file(STRINGS "${abut_list}" abut_earlier)
    set(abut_folders ${abut_earlier})
    list(FILTER abut_folders INCLUDE REGEX "/$")
    list(FILTER abut_earlier EXCLUDE REGEX "/$")
  endif()
  foreach(folder IN ITEMS . bin include lib lib/cmake lib/pkgconfig share share/bash-completion
      share/bash-completion/completions share/doc share/man share/man/man1 share/zsh
      share/zsh/site-functions share/zsh/vendor-completions)
    if(NOT EXISTS "${abut_root}/${folder}")
      list(APPEND abut_folders "${folder}/")
    endif()
  endforeach()
endif()
