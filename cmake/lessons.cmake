# cmake [-D OUTPUT=DIR] [-D PREFIX=DIR] -P cmake/lessons.cmake: writes the interactive pages of the lessons to
# build/lessons or OUTPUT, with this library or the one installed in PREFIX (examples/lessons/README.md). The pages need
# no network. Debian's clang and wasi-libc compile the estimator to WebAssembly; once these packages are installed, no
# network is needed for that either.
include("${CMAKE_CURRENT_LIST_DIR}/steps.cmake")
gonio_set_up(libeigen3-dev clang-19 lld-19 wasi-libc libclang-rt-19-dev-wasm32 libc++-19-dev-wasm32 libc++abi-19-dev-wasm32)
if(NOT OUTPUT)
  set(OUTPUT "${source}/build/lessons")
endif()
set(include "${source}/include")
set(materials "${source}/examples/data/materials.prior")
set(directions "${source}/examples/data/directions")
if(PREFIX)
  set(include "${PREFIX}/include")
  set(materials "${PREFIX}/share/gonio/materials.prior")
  set(directions "${PREFIX}/share/gonio/directions")
endif()
set(lessons "${source}/examples/lessons")
set(report "${source}/examples/report")
file(MAKE_DIRECTORY "${OUTPUT}")
find_path(eigen Eigen/Core PATHS /usr/include /usr/local/include PATH_SUFFIXES eigen3 NO_CACHE REQUIRED)
find_program(clang NAMES clang++-19 clang++ NO_CACHE REQUIRED)

# WebAssembly has 32-bit indices, so the warning that a cell's number fits into 32 bits is useless.
set(estimator "${OUTPUT}/estimator.wasm")
step("lessons: the estimator" "${clang}" --target=wasm32-wasi -mexec-model=reactor -msimd128 -std=c++20 -O2 -DNDEBUG
     -Wno-c++11-narrowing "-I${lessons}/single_threaded" "-I${include}" -isystem "${eigen}" -Wl,--strip-all
     "${lessons}/estimator.cpp" -o "${estimator}")

# base64(RESULT FILE FIRST): encodes the bytes of a file from number FIRST on, counted from 1.
function(base64 result file first)
  execute_process(COMMAND tail -c "+${first}" "${file}" COMMAND base64 -w 0 OUTPUT_VARIABLE text COMMAND_ERROR_IS_FATAL ANY)
  set(${result} "${text}" PARENT_SCOPE)
endfunction()

# The prior's payload follows a header of 25 bytes (docs/reference/formats.md).
base64(module "${estimator}" 1)
base64(prior "${materials}" 26)
# theta_i, phi_i, theta_o and phi_o of each direction.
file(STRINGS "${directions}/point-20-perceived.csv" rows REGEX "^[0-9]")
list(JOIN rows "], [" rows)
set(data "{\"estimator\": \"${module}\", \"prior\": \"${prior}\", \"directions\": [[${rows}]]}")
file(REMOVE "${estimator}")

# Template and style are those of gonio report's pages. Their content policy forbids WebAssembly; allow it here.
file(READ "${report}/page.html" form)
string(REPLACE "script-src 'unsafe-inline'" "script-src 'unsafe-inline' 'wasm-unsafe-eval'" form "${form}")
function(text_of result)
  set(text)
  foreach(file IN LISTS ARGN)
    file(READ "${file}" piece)
    string(APPEND text "${piece}")
  endforeach()
  set(${result} "${text}" PARENT_SCOPE)
endfunction()
text_of(style "${report}/style.css" "${lessons}/style.css")
text_of(bundle "${report}/bundle.js")
text_of(components "${report}/tables.js" "${report}/elements.js" "${report}/mesh.js" "${report}/environment.js" "${report}/shading.js"
        "${report}/viewer.js" "${report}/controls.js" "${lessons}/estimator.js" "${lessons}/changing_table.js"
        "${lessons}/components.js")
text_of(library "${report}/tables.js" "${report}/elements.js" "${report}/mesh.js" "${report}/environment.js" "${report}/shading.js"
        "${report}/viewer.js" "${report}/controls.js" "${lessons}/estimator.js" "${lessons}/changing_table.js"
        "${lessons}/library.js")
text_of(spoil "${report}/tables.js" "${report}/elements.js" "${lessons}/estimator.js" "${lessons}/spoil.js")
foreach(page IN ITEMS "components:Five components by slider" "spoil:Spoil a sample"
        "library:Materials to browse")
  string(REGEX MATCH "(.*):(.*)" matched "${page}")
  set(html "${form}")
  foreach(part IN ITEMS "TITLE:CMAKE_MATCH_2" STYLE:style DATA:data BUNDLE:bundle "SCRIPT:${CMAKE_MATCH_1}")
    string(REPLACE ":" ";" part "${part}")
    list(GET part 0 mark)
    list(GET part 1 variable)
    string(REPLACE "@${mark}@" "${${variable}}" html "${html}")
  endforeach()
  file(WRITE "${OUTPUT}/${CMAKE_MATCH_1}.html" "${html}")
endforeach()
message("\nThe pages are in ${OUTPUT}")
