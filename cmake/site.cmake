# cmake [-D TOOL=build/bin/gonio] -P cmake/site.cmake (or the target `site`): writes a static site to build/site, from
# docs/ and README.md, with search, ten materials to turn under a light, interactive lessons, and the reference of all
# headers. Without a TOOL or a built one, builds the tool as demo.cmake does. Needs mkdocs-material, Doxygen,
# linkchecker and the packages of lessons.cmake from Debian, and then no network. A warning of any of them, or a dead
# link, is an error.
include("${CMAKE_CURRENT_LIST_DIR}/steps.cmake")
gonio_set_up(${gonio_library_packages} mkdocs mkdocs-material doxygen linkchecker)

set(site "${source}/build/site")
set(pages "${source}/build/site-pages")
file(REMOVE_RECURSE "${site}" "${pages}")
file(READ "${source}/CMakeLists.txt" lists)
string(REGEX MATCH "VERSION ([0-9.]+)" found "${lists}")
set(version "${CMAKE_MATCH_1}")

# Copy the files that pages link to, in the repository's layout: relative links stay valid.
file(COPY "${source}/README.md" "${source}/CHANGELOG.md" "${source}/CONTRIBUTING.md" "${source}/SECURITY.md" "${source}/docs"
     DESTINATION "${pages}")
file(COPY "${source}/examples/data/directions/README.md" DESTINATION "${pages}/examples/data/directions")
file(COPY "${source}/examples/python/notebooks/twenty_numbers.ipynb" DESTINATION "${pages}/examples/python/notebooks")
file(COPY "${source}/examples/learn/spheres_by_number.sh" DESTINATION "${pages}/examples/learn")
file(GLOB programs RELATIVE "${source}/examples/learn" "${source}/examples/learn/*.cpp")
set(listing "# Teaching programs\n")
foreach(program IN LISTS programs)
  file(READ "${source}/examples/learn/${program}" code)
  string(APPEND listing "\n## ${program}\n\n```cpp\n${code}```\n")
endforeach()
file(WRITE "${pages}/examples/learn/README.md" "${listing}")

# Reports of ten materials of the shipped prior, each reconstructed from 20 samples.
foreach(built IN ITEMS test demo release)
  if(NOT TOOL AND EXISTS "${source}/build/${built}/bin/gonio")
    set(TOOL "${source}/build/${built}/bin/gonio")
  endif()
endforeach()
if(NOT TOOL)
  step("site: the tool" ${cmake} -P cmake/demo.cmake)
  set(TOOL "${source}/build/demo/bin/gonio")
endif()
set(viewer "# Turn it under a light

Ten materials of the shipped prior: from 20 samples with 2 % of noise, beside the truth. Each page is what `gonio report --truth` writes
([a page for people](docs/learn/report.md)): drag the light, look at the lobe, show how well directions are known. The prior has seen
these materials; [how it does with others](docs/results/real-materials.md) is measured elsewhere.

|   |   |   |   |   |
|---|---|---|---|---|
")
file(MAKE_DIRECTORY "${pages}/viewer")
message("\n== site: ten materials")
set(shown white-fabric pink-felt cardboard red-plastic vch_golden_yellow
          satin_gold blue-metallic-paint gold-paint brass specular-violet-phenolic)
while(shown)
  foreach(column RANGE 1 5)
    list(POP_FRONT shown material)
    foreach(line IN ITEMS
            "expand --name ${material} -o truth.binary"
            "sample truth.binary --directions ${source}/examples/data/nielsen-20.csv --noise 0.02 -o samples.csv"
            "report samples.csv --noise 0.02 --truth truth.binary --title ${material} -o ${material}.html"
            "render truth.binary --size 128 -o ${material}.png")
      separate_arguments(arguments UNIX_COMMAND "${line}")
      execute_process(COMMAND "${TOOL}" ${arguments} WORKING_DIRECTORY "${pages}/viewer" OUTPUT_QUIET ERROR_QUIET
                      COMMAND_ERROR_IS_FATAL ANY)
    endforeach()
    string(APPEND viewer "| [![${material}](viewer/${material}.png)](viewer/${material}.html)<br>${material} ")
  endforeach()
  string(APPEND viewer "|\n")
endwhile()
file(REMOVE "${pages}/viewer/truth.binary" "${pages}/viewer/samples.csv")
string(APPEND viewer "
Three pages compute in the browser: [all materials of the prior to browse](library.md), beside one another and beside a model;
[five components by slider](viewer/components.html), of the lesson on
[why 20 measurements are enough](docs/learn/why-twenty.md), and [spoil a sample](viewer/spoil.html), of the lesson on
[outliers](docs/learn/robust-estimation.md).
")
file(WRITE "${pages}/viewer.md" "${viewer}")
step("site: lessons that compute" ${cmake} -D "OUTPUT=${pages}/viewer" -P cmake/lessons.cmake)

# In the lessons, replace the text between the marks of a viewer by the interactive page.
file(GLOB lessons "${pages}/docs/learn/*.md")
foreach(lesson IN LISTS lessons)
  file(READ "${lesson}" text)
  string(REGEX REPLACE "<!-- viewer ([a-z_-]+) -->[^<]*<!-- end of viewer -->"
         "<iframe src=\"../../viewer/\\1.html\" title=\"\\1, interactive\" width=\"100%\" height=\"900\"></iframe>\n<a href=\"../../viewer/\\1.html\">\\1, as a page of its own</a>" shown "${text}")
  if(shown MATCHES "<!-- viewer")
    message(FATAL_ERROR "${lesson}: text between the marks of a viewer must be without <")
  endif()
  if(NOT shown STREQUAL text)
    file(WRITE "${lesson}" "${shown}")
  endif()
endforeach()

# title_of(RESULT PAGE): returns the first heading of a page.
function(title_of result page)
  file(STRINGS "${pages}/${page}" heading REGEX "^# " LIMIT_COUNT 1)
  string(REGEX REPLACE "^# *|[`\"]" "" heading "${heading}")
  set(${result} "${heading}" PARENT_SCOPE)
endfunction()

# add_folder(TITLE FOLDER) appends a folder's pages to the navigation: in the order in which its README.md names them,
# then the others by name.
function(add_folder title folder)
  string(APPEND nav "  - \"${title}\":\n")
  set(ordered)
  if(EXISTS "${pages}/${folder}/README.md")
    string(APPEND nav "    - ${folder}/README.md\n")
    file(READ "${pages}/${folder}/README.md" text)
    string(REGEX MATCHALL "\\([a-z0-9-]+\\.md" links "${text}")
    list(TRANSFORM links REPLACE "^\\(" "" OUTPUT_VARIABLE ordered)
  endif()
  file(GLOB others RELATIVE "${pages}/${folder}" "${pages}/${folder}/*.md")
  list(APPEND ordered ${others})
  list(REMOVE_ITEM ordered README.md)
  list(REMOVE_DUPLICATES ordered)
  foreach(page IN LISTS ordered)
    title_of(heading "${folder}/${page}")
    string(APPEND nav "    - \"${heading}\": ${folder}/${page}\n")
  endforeach()
  set(nav "${nav}" PARENT_SCOPE)
endfunction()

file(WRITE "${pages}/library.md" "# Materials to browse

<iframe src=\"viewer/library.html\" title=\"Materials to browse, interactive\" width=\"100%\" height=\"1400\"></iframe>
<a href=\"viewer/library.html\">Materials to browse, as a page of its own</a>
")
set(nav "  - Home: README.md\n  - Turn it under a light: viewer.md\n  - Materials to browse: library.md\n  - Gallery: docs/gallery.md\n")
add_folder("How do I ..." docs/learn)
add_folder("What is there" docs/reference)
add_folder("Results" docs/results)
add_folder("Decisions" docs/decisions)
string(APPEND nav "  - Teaching programs: examples/learn/README.md\n  - Directions that ship: examples/data/directions/README.md\n"
                  "  - Reference of the headers: headers.md\n  - Changes: CHANGELOG.md\n  - Contributing: CONTRIBUTING.md\n"
                  "  - Security: SECURITY.md\n")
file(WRITE "${pages}/headers.md" "# Reference of the headers\n\n"
     "Every public class and function with its docstring, made by Doxygen: [by header](headers/files.html), "
     "[classes and concepts](headers/annotated.html), [search](headers/index.html).\n")

configure_file("${source}/cmake/site/mkdocs.yml.in" "${source}/build/site-mkdocs.yml" @ONLY)
configure_file("${source}/cmake/site/Doxyfile.in" "${source}/build/site-Doxyfile" @ONLY)
step("site: reference of the headers" doxygen build/site-Doxyfile)
step("site: pages" mkdocs build --quiet --config-file build/site-mkdocs.yml)
step("site: links" linkchecker --no-status --no-warnings "${site}/index.html")
message("\nThe site is in ${site}. Its search needs a server: python3 -m http.server --directory ${site}")
