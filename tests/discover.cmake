# Included by CTest for a program of tests, with `program`, a `filter` of GoogleTest and `properties`. Adds each test; the
# instances of a parameterised test are one, since each process would read all methods anew. A filter that selects no test
# would pass, and therefore fails (tests/lists.py compares the filters with the tests).
if(NOT EXISTS "${program}")
  add_test("${program}_is_not_built" "${program}") # which fails
  return()
endif()
execute_process(COMMAND "${program}" --gtest_list_tests "--gtest_filter=${filter}"
                OUTPUT_VARIABLE lines RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "${program} does not list its tests (${failed})")
endif()
string(REGEX REPLACE " +#[^\n]*" "" lines "${lines}") # values of parameters
string(REPLACE "\n" ";" lines "${lines}")
set(previous "")
foreach(line IN LISTS lines)
  if(line MATCHES "^([^ ]+)\\.$")
    set(suite "${CMAKE_MATCH_1}")
  elseif(line MATCHES "^  ([^/]+)")
    set(name "${suite}.${CMAKE_MATCH_1}")
    set(instances "")
    if(line MATCHES "/")
      set(instances "/*")
    endif()
    if(NOT name STREQUAL previous)
      set(previous "${name}")
      add_test("${name}" "${program}" "--gtest_filter=${name}${instances}")
      set_tests_properties("${name}" PROPERTIES FAIL_REGULAR_EXPRESSION "Running 0 tests" ${properties})
    endif()
  endif()
endforeach()
