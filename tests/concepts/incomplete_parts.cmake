# If a decomposition's metric, basis or solver lacks a member, the first ten lines of the compiler's output name it.
cmake_minimum_required(VERSION 3.25)
list(TRANSFORM INCLUDES PREPEND -I)
string(REPEAT "[^\n]*\n" 10 ten_lines)

function(gonio_expect macro sentence)
  execute_process(
    COMMAND "${COMPILER}" -std=c++20 -fsyntax-only -DGONIO_COMPILED -D${macro} ${INCLUDES}
            "${CMAKE_CURRENT_LIST_DIR}/incomplete_part.cpp"
    ERROR_VARIABLE answer OUTPUT_QUIET)
  string(REGEX MATCH "^${ten_lines}" lines "${answer}")
  string(FIND "${lines}" "${sentence}" found)
  if(found EQUAL -1)
    message(SEND_ERROR "${macro}: '${sentence}' is not among the compiler's first ten lines:\n${answer}")
  endif()
endfunction()

gonio_expect(WITHOUT_INVERSE "decomposition: the metric of the basis has no inverse(y, cell)")
gonio_expect(WITHOUT_ROW "decomposition: the basis has neither row(cell) nor read_row(location, out)")
gonio_expect(WITHOUT_SOLVE "decomposition: the solver has no solve(problem)")
