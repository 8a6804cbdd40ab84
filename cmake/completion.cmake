# cmake -D TOOL=build/.../bin/gonio -D OUTPUT=gonio -P cmake/completion.cmake: writes the script by which bash (and zsh
# after `autoload bashcompinit; bashcompinit`) completes the tool's subcommands, its options, and the options' values if
# these are words of a list.
cmake_minimum_required(VERSION 3.25)
include("${CMAKE_CURRENT_LIST_DIR}/tool_help.cmake")

# describe(WORD...): adds the script's cases for the tool or a subcommand, and for its own subcommands.
function(describe)
  gonio_tool_help(help "${TOOL}" ${ARGN})
  gonio_subcommands(subcommands "${help}")
  string(JOIN " " name gonio ${ARGN})
  set(options)
  set(rest "${help}")
  while(NOT rest STREQUAL "")
    gonio_first_line(line rest)
    if(NOT line MATCHES "^ +(-[a-zA-Z],)?(--[a-z0-9-]+)")
      continue()
    endif()
    set(option "${CMAKE_MATCH_2}")
    list(APPEND options ${option})
    if(line MATCHES "TEXT:{([^}]*)}")
      string(REPLACE "," " " values "${CMAKE_MATCH_1}")
      set_property(GLOBAL APPEND_STRING PROPERTY values "    '${name} ${option}') words='${values}' ;;\n")
    endif()
  endwhile()
  string(JOIN " " options ${options})
  string(JOIN " " words ${subcommands})
  set_property(GLOBAL APPEND_STRING PROPERTY commands "    '${name}') subcommands='${words}' options='${options}' ;;\n")
  foreach(subcommand IN LISTS subcommands)
    describe(${ARGN} ${subcommand})
  endforeach()
endfunction()

describe()
get_property(commands GLOBAL PROPERTY commands)
get_property(values GLOBAL PROPERTY values)
file(WRITE "${OUTPUT}" "# Completion of gonio for bash.
_gonio_words() {
  local subcommands= options=
  case \"$1\" in
${commands}  esac
  case \"$2\" in
    subcommands) echo \"$subcommands\" ;;
    options) echo \"$options\" ;;
  esac
}

_gonio_values() {
  local words=
  case \"$1\" in
${values}  esac
  echo \"$words\"
}

_gonio() {
  local current=\"\${COMP_WORDS[COMP_CWORD]}\" previous=\"\${COMP_WORDS[COMP_CWORD - 1]}\" command=gonio word words
  for word in \"\${COMP_WORDS[@]:1:COMP_CWORD - 1}\"; do
    words=\" $(_gonio_words \"$command\" subcommands) \"
    [[ \"$words\" == *\" $word \"* ]] && command=\"$command $word\"
  done
  words=\"$(_gonio_values \"$command $previous\")\"
  if [[ -n \"$words\" ]]; then
    mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$current\")
  elif [[ \"$current\" == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W \"$(_gonio_words \"$command\" options)\" -- \"$current\")
  else
    mapfile -t COMPREPLY < <(compgen -W \"$(_gonio_words \"$command\" subcommands)\" -- \"$current\")
  fi
}
complete -o default -F _gonio gonio
")
