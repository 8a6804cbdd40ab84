# Shared by the scripts that read the tool's help.

# gonio_tool_help(RESULT TOOL WORD...): returns the output of `TOOL WORD... --help`, or of --help-all for a subcommand
# with more options.
function(gonio_tool_help result tool)
  execute_process(COMMAND "${tool}" ${ARGN} --help OUTPUT_VARIABLE help COMMAND_ERROR_IS_FATAL ANY)
  if(help MATCHES " --help-all prints more options")
    execute_process(COMMAND "${tool}" ${ARGN} --help-all OUTPUT_VARIABLE help COMMAND_ERROR_IS_FATAL ANY)
  endif()
  string(REGEX REPLACE "\n+$" "\n" help "${help}")
  set(${result} "${help}" PARENT_SCOPE)
endfunction()

# gonio_subcommands(RESULT HELP): returns the names of the subcommands in a help, under any heading. Unlike them, a
# positional argument is followed by one blank and capitals.
function(gonio_subcommands result help)
  string(REGEX MATCHALL "\n  [a-z][a-z-]*  " names "${help}")
  string(REGEX REPLACE "[\n ]" "" names "${names}")
  set(${result} ${names} PARENT_SCOPE)
endfunction()

# gonio_first_line(LINE REST): moves the first line of the variable REST to LINE. A list of lines is impossible, because
# help contains brackets and semicolons.
macro(gonio_first_line line rest)
  string(FIND "${${rest}}" "\n" gonio_end)
  string(SUBSTRING "${${rest}}" 0 ${gonio_end} ${line})
  math(EXPR gonio_end "${gonio_end} + 1")
  string(SUBSTRING "${${rest}}" ${gonio_end} -1 ${rest})
endmacro()
