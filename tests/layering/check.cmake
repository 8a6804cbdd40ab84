# Fails if a header under ROOT (an include/gonio folder) includes against the arrows of
# docs/architecture.md: cmake -D ROOT=include/gonio -P check.cmake
cmake_minimum_required(VERSION 3.25)

# "user -> used ..."; whoever may include a module may include what that module may include.
# A module is a folder, or a single header where that has rules of its own. Used before user.
set(edges
  "core       ->"
  "solve      -> core"
  "table      -> core"
  "metric     -> table"
  "basis      -> metric solve"
  "estimate   -> basis"
  "design     -> basis"
  "model      -> table solve metric"
  "capture    -> table solve"
  "render     -> table"
  "evaluate   -> estimate render design"
  "shape      -> estimate render"
  "io         -> design capture model render"
  "io/image.hpp -> io" # apart, because it needs stb
  "io/mesh.hpp  -> io shape" # apart, because they need what shape/ does
  "io/shape_model.hpp -> io shape"
  "render.hpp -> render"
  "shape.hpp  -> shape io/mesh.hpp io/shape_model.hpp"
  "gonio.hpp  -> estimate design model capture render evaluate io")

foreach(edge IN LISTS edges)
  string(REGEX MATCHALL "[a-z_./]+" modules "${edge}") # the arrow itself does not match
  list(POP_FRONT modules user)
  set(allowed_${user} ${user})
  foreach(used IN LISTS modules)
    list(APPEND allowed_${user} ${allowed_${used}})
  endforeach()
endforeach()

# The module of a path relative to ROOT.
function(module_of path result)
  string(REGEX REPLACE "/.*" "" module "${path}")
  if(DEFINED allowed_${path})
    set(module "${path}")
  endif()
  set(${result} "${module}" PARENT_SCOPE)
endfunction()

set(violations 0)
file(GLOB_RECURSE headers RELATIVE "${ROOT}" "${ROOT}/*.hpp")
foreach(header IN LISTS headers)
  module_of("${header}" user)
  file(READ "${ROOT}/${header}" text)
  set(text "\n${text}")
  string(REGEX MATCHALL "\n[ \t]*#[ \t]*include[ \t]*[<\"][^>\"\n]+" directives "${text}")
  foreach(directive IN LISTS directives)
    # A path relative to the header, or one from the include root; else it is not ours.
    string(REGEX REPLACE ".*[<\"]" "" path "${directive}")
    if(path MATCHES "^gonio/")
      string(REGEX REPLACE "^gonio/" "" used_path "${path}")
    elseif(directive MATCHES "\"")
      cmake_path(GET header PARENT_PATH used_path)
      cmake_path(APPEND used_path "${path}")
      cmake_path(NORMAL_PATH used_path)
    else()
      continue()
    endif()

    module_of("${used_path}" used)
    if(NOT used IN_LIST allowed_${user})
      string(FIND "${text}" "${directive}" position)
      string(SUBSTRING "${text}" 0 ${position} before)
      string(REGEX MATCHALL "\n" newlines "${before}")
      list(LENGTH newlines line)
      math(EXPR line "${line} + 1")
      message("${header}:${line}: ${user} must not include ${used} (${used_path})")
      math(EXPR violations "${violations} + 1")
    endif()
  endforeach()
endforeach()

# Between them gonio.hpp and shape.hpp, which needs libraries of its own, have everything, but for what needs stb.
if(EXISTS "${ROOT}/gonio.hpp")
  file(READ "${ROOT}/gonio.hpp" everything)
  file(READ "${ROOT}/shape.hpp" shapes)
  foreach(header IN LISTS headers)
    string(FIND "${everything}${shapes}" "<gonio/${header}>" place)
    if(place EQUAL -1 AND NOT header MATCHES "^(gonio|render|shape|io/image)\\.hpp$")
      message(FATAL_ERROR "neither gonio.hpp nor shape.hpp includes ${header}")
    endif()
  endforeach()
endif()

if(violations GREATER 0)
  message(FATAL_ERROR "layering: ${violations} forbidden includes")
endif()
