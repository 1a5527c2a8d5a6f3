# Read by ctest: the suites of `program` (cmake/suites.cmake), with `properties`.
if(EXISTS ${program})
  execute_process(COMMAND ${program} --gtest_list_tests OUTPUT_VARIABLE listed
    COMMAND_ERROR_IS_FATAL ANY)
  # Suites begin in the first column and end in a dot: [PARAMETERS/]SUITE.
  string(REGEX MATCHALL "(^|\n)[^ \n]+\\." heads "${listed}")
  list(TRANSFORM heads REPLACE "[\n.]|.*/" "")
  list(REMOVE_DUPLICATES heads)
  foreach(suite IN LISTS heads)
    add_test(${suite} ${program} --gtest_brief=1 "--gtest_filter=${suite}.*:*/${suite}.*")
    set_tests_properties(${suite} PROPERTIES ${properties})
  endforeach()
else()  # which fails as missing, and does not pass by being absent
  get_filename_component(name ${program} NAME)
  add_test(${name}_NOT_BUILT ${program})
endif()
