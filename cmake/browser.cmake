# Part of checks.cmake: sees to it that the tests labelled browser find chromium, Node.js and what npm ci brings. Where they
# cannot be had it says so, and the tests say that they are skipped.
if(SET_UP)
  include("${CMAKE_CURRENT_LIST_DIR}/steps.cmake")
  gonio_set_up(chromium nodejs npm)
  return()
endif()
message("\n== browser: chromium and npm ci")
execute_process(COMMAND ${cmake} -D SET_UP=ON -P cmake/browser.cmake WORKING_DIRECTORY "${source}" RESULT_VARIABLE failed
                OUTPUT_QUIET ERROR_QUIET)
if(NOT failed)
  execute_process(COMMAND npm ci --no-audit --no-fund WORKING_DIRECTORY "${source}/examples/report" TIMEOUT 300
                  RESULT_VARIABLE failed OUTPUT_QUIET ERROR_QUIET)
endif()
if(failed)
  message("== browser: not here: there is no chromium, no npm or no registry")
endif()
