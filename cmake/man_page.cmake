# cmake -D TOOL=build/.../bin/gonio -D VERSION=X.Y.Z -D OUTPUT=gonio.1 -P cmake/man_page.cmake: writes the tool's manual
# page from its help.
cmake_minimum_required(VERSION 3.25)
include("${CMAKE_CURRENT_LIST_DIR}/tool_help.cmake")

# escaped(RESULT TEXT): escapes backslashes, hyphens and the beginnings of requests for roff.
function(escaped result text)
  string(REPLACE "\\" "\\e" text "${text}")
  string(REPLACE "-" "\\-" text "${text}")
  string(REGEX REPLACE "^([.'])" "\\\\&\\1" text "${text}")
  set(${result} "${text}" PARENT_SCOPE)
endfunction()

# describe(WORD...): adds a section for the tool or a subcommand, and for its own subcommands.
function(describe)
  gonio_tool_help(help "${TOOL}" ${ARGN})
  string(JOIN " " name gonio ${ARGN})
  escaped(text "${name}")
  set(page ".SS ${text}\n")
  set(rest "${help}")
  while(NOT rest STREQUAL "")
    gonio_first_line(line rest)
    if(line MATCHES "^          +(.*)$") # a description that did not fit beside its option
      escaped(text "${CMAKE_MATCH_1}")
      string(APPEND page "${text}\n")
    elseif(line MATCHES "^  (gonio .*)$")
      escaped(text "${CMAKE_MATCH_1}")
      string(APPEND page ".PP\n.B ${text}\n")
      set_property(GLOBAL APPEND_STRING PROPERTY examples ".PP\n.B ${text}\n")
    elseif(line MATCHES "^ +([^ ]+( [^ ]+)*)  +(.*)$")
      escaped(term "${CMAKE_MATCH_1}")
      escaped(text "${CMAKE_MATCH_3}")
      string(APPEND page ".TP\n.B ${term}\n${text}\n")
    elseif(line MATCHES "^  +(-.*)$")
      escaped(term "${CMAKE_MATCH_1}")
      string(APPEND page ".TP\n.B ${term}\n")
    elseif(NOT line STREQUAL "")
      string(STRIP "${line}" line)
      escaped(text "${line}")
      string(APPEND page ".PP\n${text}\n")
    endif()
  endwhile()
  set_property(GLOBAL APPEND_STRING PROPERTY page "${page}")
  gonio_subcommands(subcommands "${help}")
  foreach(subcommand IN LISTS subcommands)
    describe(${ARGN} ${subcommand})
  endforeach()
endfunction()

describe()
get_property(commands GLOBAL PROPERTY page)
get_property(examples GLOBAL PROPERTY examples)
file(WRITE "${OUTPUT}" ".TH GONIO 1 \"\" \"gonio ${VERSION}\" \"User Commands\"
.SH NAME
gonio \\- complete BRDFs from a few reflectance measurements
.SH SYNOPSIS
.B gonio
.I SUBCOMMAND
.RI [ OPTIONS ]
.SH DESCRIPTION
gonio completes a BRDF from a few measured directions and a prior of known materials. It says how sure each value is, and
where to measure next. Angles are degrees; reflectance is in sr^\\-1 without the
cosine.
.SH COMMANDS
${commands}.SH EXAMPLES
${examples}.SH EXIT STATUS
.TP
.B 0
The work is done; of
.BR check :
no difference is found.
.TP
.B 1
Of
.BR check :
the part differs.
.TP
.B 2
The input is bad: one sentence says what, where and what was expected. Nothing is written.
")
