# Shared by the tests of the library and of the projects beside it: test_main and gonio_add_tests.
find_package(doctest REQUIRED CONFIG)
find_package(nlohmann_json REQUIRED CONFIG)
# RapidCheck is compiled with libstdc++. With another standard library, the tests that use it cannot be linked.
option(GONIO_TEST_PROPERTIES "Build the tests that need RapidCheck" ON)
if(GONIO_TEST_PROPERTIES)
  find_package(rapidcheck REQUIRED CONFIG)
endif()

# Sources that all test programs share: doctest's main, and files that take long to compile.
set(tests "${gonio_source}/tests")
add_library(test_main OBJECT "${tests}/doctest_main.cpp" "${tests}/dense_reference.cpp" "${tests}/golden.cpp")
# Only a file without Eigen: the linker takes an Eigen function from any object that has it, and one compiled with -O0
# would make all tests slow.
set_source_files_properties("${tests}/golden.cpp" PROPERTIES COMPILE_OPTIONS -O0 SKIP_PRECOMPILE_HEADERS ON)
target_link_libraries(test_main PUBLIC
  gonio_executables doctest::doctest $<TARGET_NAME_IF_EXISTS:rapidcheck> nlohmann_json::nlohmann_json
  gonio_warnings gonio_native)
target_include_directories(test_main PUBLIC "${tests}" "${gonio_source}/examples") # for the simulated laboratories
target_compile_definitions(test_main PUBLIC
  DOCTEST_CONFIG_VOID_CAST_EXPRESSIONS # lets CHECK_THROWS take a [[nodiscard]] call
  GONIO_SOURCE_DIR="${gonio_source}"
  GONIO_TEST_DATA="${tests}/data"
  GONIO_SHARED_DATA="${gonio_source}/../shared/data") # may be absent
# Tests compile far longer than they run.
target_compile_options(test_main PUBLIC $<$<CONFIG:Release>:-O1>)
target_precompile_headers(test_main PRIVATE
  <doctest/doctest.h> <Eigen/Core> <Eigen/Cholesky> <string> <vector>)

# Modules whose files compile one by one, and single files of the others: they use a name of another file in an unnamed
# namespace.
set(GONIO_TESTS_APART io model papers long crafted crafted_shapes shape_commands)
set(GONIO_FILES_APART cli/kills cli/lab cli/svbrdf_masks render/slice render/sphere)
# gonio_add_tests(MODULE LABEL TIMEOUT SOURCE...): adds the program test_MODULE and its test. If the variable
# first_cases is set, adds two tests: the first first_cases cases, and the others. `cases` is a filter.
function(gonio_add_tests module label timeout)
  set(sources ${ARGN})
  foreach(file IN LISTS sources)
    file(STRINGS ${file} property REGEX rapidcheck LIMIT_COUNT 1)
    if(property AND NOT GONIO_TEST_PROPERTIES)
      list(REMOVE_ITEM sources ${file})
    endif()
  endforeach()
  if(NOT sources)
    return()
  endif()
  add_executable(test_${module} ${sources})
  target_link_libraries(test_${module} PRIVATE test_main)
  target_precompile_headers(test_${module} REUSE_FROM test_main)
  # Compile files of a module together, because they share templates.
  if(NOT module IN_LIST GONIO_TESTS_APART)
    set_target_properties(test_${module} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 7
      UNITY_BUILD_CODE_BEFORE_INCLUDE "#pragma GCC diagnostic ignored \"-Wshadow\"") # names of other files
    foreach(file IN LISTS GONIO_FILES_APART)
      set_source_files_properties("${tests}/${file}.cpp" PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    endforeach()
  endif()
  set(tests ${module})
  if(first_cases) # two tests, which may run in parallel
    math(EXPR next "${first_cases} + 1")
    add_test(NAME ${module} COMMAND test_${module} ${cases} --last=${first_cases})
    add_test(NAME ${module}_more COMMAND test_${module} ${cases} --first=${next})
    list(APPEND tests ${module}_more)
  else()
    add_test(NAME ${module} COMMAND test_${module})
  endif()
  set_tests_properties(${tests} PROPERTIES LABELS ${label} TIMEOUT ${timeout} COST ${timeout}) # the longest first
endfunction()

# gonio_skip(NAME REASON): adds a test that this build lacks. ctest lists it as skipped, with the reason.
function(gonio_skip name reason)
  add_test(NAME "${name}: ${reason}" COMMAND "${CMAKE_COMMAND}" -E echo skipped)
  set_tests_properties("${name}: ${reason}" PROPERTIES LABELS fast SKIP_REGULAR_EXPRESSION "^skipped")
endfunction()
