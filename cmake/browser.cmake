# Part of checks.cmake: installs chromium, Node.js and the packages of npm ci for the tests labelled browser. If that
# fails, it prints a message, and the tests report that they are skipped.
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
  message("== browser: skipped: chromium, npm or its registry is missing")
endif()
