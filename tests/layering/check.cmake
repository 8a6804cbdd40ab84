# cmake -D ROOT=include/gonio,shape/include/gonio -P check.cmake: fails if a header under ROOT, one or several
# include/gonio folders, includes a module against the arrows of docs/reference/architecture.md. COMPLETE: also fails if
# an included header does not exist.
cmake_minimum_required(VERSION 3.25)

# "user -> used ...": a user may include the used modules and all that these may include. A module is a folder, or a
# folder or header within it that has its own rules. A module is listed before its users.
set(edges
  "core       ->"
  "core/k_d_tree.hpp -> core" # apart, because it needs nanoflann
  "solve      -> core"
  "table      -> core"
  "metric     -> table"
  "basis      -> metric solve"
  "estimate/estimator.hpp -> table" # only the concept, which needs no basis
  "estimate   -> basis estimate/estimator.hpp"
  "interpolate -> metric estimate/estimator.hpp"
  "interpolate/scattered_brdf.hpp -> interpolate core/k_d_tree.hpp" # apart, because it needs nanoflann
  "robust     -> estimate interpolate"
  "conformity -> estimate"
  "design     -> estimate"
  "model      -> table solve metric"
  "capture    -> table solve"
  "render     -> table"
  "texels/texel_brdf.hpp -> render" # apart, because a renderer needs it
  "texels     -> estimate texels/texel_brdf.hpp"
  "evaluate   -> estimate render design"
  "shape      -> estimate render core/k_d_tree.hpp"
  "io/bytes   -> core"
  "io/text    -> io/bytes"
  "io/measurements -> io/text capture model"
  "io/materials -> io/text model texels"
  "io/images  -> io/text render"
  "io/setups  -> io/text capture design"
  "io         -> io/measurements io/materials io/images io/setups"
  "io/images/image.hpp -> io/images" # apart, because it needs stb
  "io/images/exr.hpp -> io/images" # apart, because it needs OpenEXR
  "io/images/tiff.hpp -> io/images" # libtiff
  "io/images/exif.hpp -> io/images" # libexif
  "shape/io   -> io shape"
  "mpi        -> core" # apart, because it needs MPI
  "render.hpp -> render texels/texel_brdf.hpp"
  "shape.hpp  -> shape/io"
  "mpi.hpp    -> mpi"
  "core.hpp -> core" # umbrella headers
  "solve.hpp -> solve"
  "table.hpp -> table"
  "metric.hpp -> metric"
  "basis.hpp -> basis"
  "estimate.hpp -> estimate"
  "robust.hpp -> robust"
  "interpolate.hpp -> interpolate"
  "conformity.hpp -> conformity"
  "texels.hpp -> texels"
  "design.hpp -> design"
  "model.hpp -> model"
  "capture.hpp -> capture"
  "evaluate.hpp -> evaluate"
  "io.hpp -> io"
  "gonio.hpp  -> estimate io")

foreach(edge IN LISTS edges)
  string(REGEX MATCHALL "[a-z_./]+" modules "${edge}") # the arrow itself does not match
  list(POP_FRONT modules user)
  set(allowed_${user} ${user})
  foreach(used IN LISTS modules)
    list(APPEND allowed_${user} ${allowed_${used}})
  endforeach()
endforeach()

# module_of(PATH RESULT): returns the module of a path relative to ROOT.
function(module_of path result)
  string(REGEX REPLACE "/impl/([a-z0-9_]+)[.]ipp$" "/\\1.hpp" path "${path}") # a body is part of its header
  cmake_path(GET path PARENT_PATH folder)
  string(REGEX REPLACE "/.*" "" module "${path}")
  foreach(narrower IN ITEMS "${folder}" "${path}")
    if(DEFINED allowed_${narrower})
      set(module "${narrower}")
    endif()
  endforeach()
  set(${result} "${module}" PARENT_SCOPE)
endfunction()

set(violations 0)
string(REPLACE "," ";" ROOT "${ROOT}") # add_test does not pass lists
foreach(root IN LISTS ROOT)
  cmake_path(ABSOLUTE_PATH root)
  file(GLOB_RECURSE headers RELATIVE "${root}" "${root}/*.hpp" "${root}/*.ipp")
  if(NOT headers)
    message(FATAL_ERROR "${root}: there are no headers")
  endif()
  foreach(header IN LISTS headers)
    module_of("${header}" user)
    file(READ "${root}/${header}" text)
    set(text "\n${text}")
    string(REGEX MATCHALL "\n[ \t]*#[ \t]*include[ \t]*[<\"][^>\"\n]+" directives "${text}")
    foreach(directive IN LISTS directives)
      # A path is relative to the header or to the include root; other headers are not ours.
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

      set(exists OFF)
      foreach(other IN LISTS ROOT)
        if(EXISTS "${other}/${used_path}")
          set(exists ON)
        endif()
      endforeach()
      if(COMPLETE AND NOT exists)
        message(FATAL_ERROR "${header}: ${used_path} does not exist")
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

  # A header is in its module's umbrella header, except those for render.hpp and those that need a library of their own
  # (core/arrays.hpp: xtensor). A body is in one of the sources of gonio::compiled, or in another body.
  if(EXISTS "${root}/../../src")
    file(GLOB sources "${root}/../../src/*.cpp")
    set(compiled)
    set(bodies ${headers})
    list(FILTER bodies INCLUDE REGEX "[.]ipp$")
    list(TRANSFORM bodies PREPEND "${root}/")
    foreach(source IN LISTS sources bodies)
      file(READ "${source}" text)
      string(APPEND compiled "${text}")
    endforeach()
    foreach(header IN LISTS headers)
      if(header MATCHES "[.]ipp$")
        set(places "${compiled}")
      elseif(header MATCHES "^(render/.*|io/images/(image|exr|tiff|exif)[.]hpp|core/(k_d_tree|arrays)[.]hpp|interpolate/scattered_brdf[.]hpp|[a-z]+[.]hpp)$")
        continue()
      else()
        string(REGEX REPLACE "/.*" "" module "${header}")
        file(READ "${root}/${module}.hpp" places)
      endif()
      string(FIND "${places}" "<gonio/${header}>" place)
      if(place EQUAL -1)
        message(FATAL_ERROR "${header} is in neither its module's header nor, if it is a body, a source of src/ or another body")
      endif()
    endforeach()
  endif()
endforeach()

if(violations GREATER 0)
  message(FATAL_ERROR "layering: ${violations} forbidden includes")
endif()
