# Read by CPack when it begins. Builds between two releases are newer than the one before, so that
# apt upgrades from one to the next: 0.1.0+git20261125.1650. A tagged commit is the version itself.
get_filename_component(source ${CMAKE_CURRENT_LIST_DIR} DIRECTORY)
find_program(git git)
if(git AND EXISTS ${source}/.git)
  set(ask ${git} -c safe.directory=* -C ${source})
  execute_process(COMMAND ${ask} describe --exact-match --match v${CPACK_PACKAGE_VERSION}
    RESULT_VARIABLE between OUTPUT_QUIET ERROR_QUIET)
  execute_process(COMMAND ${CMAKE_COMMAND} -E env TZ=UTC ${ask} log -1 --format=%cd
    --date=format-local:%Y%m%d.%H%M OUTPUT_VARIABLE when OUTPUT_STRIP_TRAILING_WHITESPACE
    ERROR_QUIET)
  if(between AND when)
    set(CPACK_DEBIAN_PACKAGE_VERSION ${CPACK_PACKAGE_VERSION}+git${when})
  endif()
endif()
