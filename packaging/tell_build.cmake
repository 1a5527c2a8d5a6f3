# Writes what is built into one C++ and one Python file, each only when it changes: a new commit
# compiles that file again, links the programs, and nothing else.
#   cmake -Dsource=DIR -Dversion=V -Doptions=TEXT -Dcompiler=TEXT -Dcommit=TEXT -Dcpp=FILE
#     -Dpython=FILE -P tell_build.cmake
# An empty commit is asked of git; where there is no git or no checkout it is unknown.
if(NOT commit)
  set(commit unknown)
  find_program(git git)
  # A source tree inside another one's checkout is not that one's commit.
  if(git AND EXISTS ${source}/.git)
    # Whoever installs as root has not the checkout's owner: git would refuse to look.
    set(ask ${git} -c safe.directory=* -C ${source})
    execute_process(COMMAND ${ask} rev-parse --short=12 HEAD
      OUTPUT_VARIABLE said OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed ERROR_QUIET)
    if(NOT failed AND said)
      set(commit ${said})
      execute_process(COMMAND ${ask} --no-optional-locks status --porcelain --untracked-files=no
        OUTPUT_VARIABLE changed ERROR_QUIET)
      if(changed)
        string(APPEND commit " + changes")
      endif()
    endif()
  endif()
endif()
get_filename_component(here ${CMAKE_CURRENT_LIST_DIR} REALPATH)
configure_file(${here}/build_info.cpp.in ${cpp} @ONLY)
configure_file(${here}/build_info.py.in ${python} @ONLY)
