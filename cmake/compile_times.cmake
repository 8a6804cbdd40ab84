# cmake [-D GUARD=ON] [-D OUTPUT=docs/results/compile-cost.md] -P cmake/compile_times.cmake: measures the CPU seconds
# and the megabytes that compilers need for README's program and for each module's header. Compares with a plain Eigen
# program of one product and one Cholesky decomposition, compiled again before each: the median of three ratios. GUARD:
# measures only README's program and gonio.hpp, and fails if one is 30 % above its goal. README's header-only program
# misses its goal; it fails at 30 % above its cost when that was accepted (docs/decisions/0036).
include("${CMAKE_CURRENT_LIST_DIR}/steps.cmake")
include("${CMAKE_CURRENT_LIST_DIR}/page_block.cmake")
gonio_set_up(${gonio_library_packages} ${gonio_shape_packages} time)
find_program(time time REQUIRED NO_CACHE)
set(scratch "${source}/build/compile_times")
file(MAKE_DIRECTORY "${scratch}")
file(WRITE "${scratch}/plain.cpp" [[
#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <fstream>
#include <string>
#include <vector>
int main(int count, char**) {
  const Eigen::MatrixXd a = Eigen::MatrixXd::Random(count, count), gram = a * a.transpose();
  const Eigen::MatrixXd x = gram.llt().solve(a);
  return static_cast<int>(x(0, 0));
}
]])

# compile(FILE OPTION...): sets `hundredths` of a second and `megabytes`.
function(compile file)
  execute_process(COMMAND "${time}" -f "%U %M" g++ -std=c++20 "-I${source}/include" "-I${source}/shape/include" -isystem /usr/include/eigen3
                          ${ARGN} -c "${file}" -o "${scratch}/object.o"
                  ERROR_VARIABLE used COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCH "([0-9]+)[.]([0-9][0-9]) ([0-9]+)\n$" line "${used}")
  math(EXPR megabytes "${CMAKE_MATCH_3} / 1024")
  math(EXPR hundredths "100 * ${CMAKE_MATCH_1} + 1${CMAKE_MATCH_2} - 100") # the leading 1 avoids octal numbers
  set(hundredths ${hundredths} PARENT_SCOPE)
  set(megabytes ${megabytes} PARENT_SCOPE)
endfunction()

# with_point(RESULT HUNDREDTHS): returns a number with two decimals.
function(with_point result hundredths)
  math(EXPR whole "${hundredths} / 100")
  math(EXPR rest "${hundredths} % 100 + 100")
  string(SUBSTRING "${rest}" 1 2 rest)
  set(${result} "${whole}.${rest}" PARENT_SCOPE)
endfunction()

# row(NAME GOAL MEGABYTES FILE OPTION...): adds a line to the table. The goal is a ratio in hundredths.
function(row name goal goal_megabytes file)
  set(limit ${goal})
  set(limit_megabytes ${goal_megabytes})
  if(header_only_most AND name MATCHES "^README's program, header-only")
    list(GET header_only_most 0 limit)
    list(GET header_only_most 1 limit_megabytes)
  endif()
  math(EXPR most "130 * ${limit} / 100")
  math(EXPR most_megabytes "130 * ${limit_megabytes} / 100")
  set(ratios)
  foreach(run RANGE 1 3)
    compile("${scratch}/plain.cpp" -O2)
    set(plain ${hundredths})
    compile("${file}" ${ARGN})
    math(EXPR ratio "100 * ${hundredths} / ${plain}")
    list(APPEND ratios ${ratio})
    if(GUARD AND ratio LESS_EQUAL most) # one run below the limit is enough
      set(ratios ${ratio} ${ratio})
      break()
    endif()
  endforeach()
  list(SORT ratios COMPARE NATURAL)
  list(GET ratios 1 ratio)
  with_point(seconds ${hundredths})
  with_point(times ${ratio})
  with_point(goal_times ${goal})
  set(line "| ${name} | ${seconds} | ${times} | ${goal_times} | ${megabytes} | ${goal_megabytes} |")
  message("${line}")
  set_property(GLOBAL APPEND_STRING PROPERTY table "${line}\n")
  if(GUARD AND (ratio GREATER most OR megabytes GREATER most_megabytes))
    message(FATAL_ERROR "${name} costs its compiler 30 % more than it may")
  endif()
endfunction()

function(header_row name goal goal_megabytes header)
  file(WRITE "${scratch}/header.cpp" "#include <${header}>\n")
  row("${name}" ${goal} ${goal_megabytes} "${scratch}/header.cpp" -O0)
endfunction()

set(heading "| what | CPU s | times the plain program | goal | MB | goal |\n|---|---|---|---|---|---|")
message("${heading}")
set(first "${source}/examples/learn/first_program.cpp")
set(header_only_most 580 750) # hundredths of the plain program, megabytes
row("README's program, header-only, -O2" 250 600 "${first}" -O2)
row("README's program, gonio::compiled, -O2" 150 600 "${first}" -O2 -DGONIO_COMPILED)
header_row("`gonio/gonio.hpp`, -O0" 400 900 gonio/gonio.hpp)
if(GUARD)
  return()
endif()
foreach(module IN ITEMS core solve table metric basis estimate robust interpolate conformity texels
    design model capture evaluate io render shape)
  header_row("`gonio/${module}.hpp`, -O0" 600 900 gonio/${module}.hpp)
endforeach()
row("the path tracer, header-only, -O2" 400 900 "${source}/examples/learn/path_tracer.cpp"
    -O2 "-I${source}/examples")
row("a metric, a basis and a solver of the reader's own, header-only, -O2" 400 900
    "${source}/tests/header_only/own_parts.cpp" -O2)

if(OUTPUT)
  compile("${scratch}/plain.cpp" -O2)
  with_point(seconds ${hundredths})
  get_property(table GLOBAL PROPERTY table)
  execute_process(COMMAND g++ -dumpfullversion OUTPUT_VARIABLE version OUTPUT_STRIP_TRAILING_WHITESPACE)
  string(TIMESTAMP today "%Y-%m-%d")
  write_block("${source}/${OUTPUT}" "cmake -P cmake/compile_times.cmake" "end of compile_times.cmake" "${heading}
${table}
Printed on ${today} by `cmake -P cmake/compile_times.cmake`, g++ ${version}. The plain program took ${seconds} s and ${megabytes} MB.
")
endif()
