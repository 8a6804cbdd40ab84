# cmake [-D GUARD=ON] [-D OUTPUT=docs/results/compile-cost.md] -P cmake/compile_times.cmake: what README's program and each
# header that has all of a module cost a compiler, in CPU seconds and megabytes, beside a plain Eigen program with one
# product and one Cholesky decomposition, which is compiled again before each: the median of three ratios. GUARD:
# README's program and gonio.hpp alone, which fail where they are 30 % above their goals; the program of the headers alone,
# which misses its goal, where it is 30 % above what it cost when that was decided (docs/decisions/0036).
include("${CMAKE_CURRENT_LIST_DIR}/steps.cmake")
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
  math(EXPR hundredths "100 * ${CMAKE_MATCH_1} + 1${CMAKE_MATCH_2} - 100") # 1 in front: no octal number
  set(hundredths ${hundredths} PARENT_SCOPE)
  set(megabytes ${megabytes} PARENT_SCOPE)
endfunction()

# with_point(RESULT HUNDREDTHS): a number with two digits behind the point.
function(with_point result hundredths)
  math(EXPR whole "${hundredths} / 100")
  math(EXPR rest "${hundredths} % 100 + 100")
  string(SUBSTRING "${rest}" 1 2 rest)
  set(${result} "${whole}.${rest}" PARENT_SCOPE)
endfunction()

# row(NAME GOAL MEGABYTES FILE OPTION...): a line of the table. The goal is a ratio in hundredths.
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
    if(GUARD AND ratio LESS_EQUAL most) # once is enough
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
  # What build_times.cmake prints stays below.
  file(READ "${source}/${OUTPUT}" page)
  string(FIND "${page}" "## README's two commands" begin)
  string(SUBSTRING "${page}" ${begin} -1 after)
  file(WRITE "${source}/${OUTPUT}" "# What the headers cost a compiler

Written by `cmake -D OUTPUT=${OUTPUT} -P cmake/compile_times.cmake`, ${today}, g++ ${version}. User CPU seconds and the largest
memory of one compiler. The plain program has one product and one Cholesky decomposition of Eigen matrices, at -O2: ${seconds} s and
${megabytes} MB here; it was compiled again before each line.

<!-- cmake -P cmake/compile_times.cmake -->

${heading}
${table}
<!-- end of cmake -->

${after}")
endif()
