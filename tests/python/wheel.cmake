# cmake -D PYTHON=/usr/bin/python3 -D SOURCE=. -D SCRATCH=build/wheel -P tests/python/wheel.cmake: builds the wheel of
# examples/python by `pip install` in a bare virtual environment, and passes the module's tests there. Build tools, numpy,
# mypy and Mitsuba come from PyPI; where that cannot be reached, it says so and nothing is tested.
cmake_minimum_required(VERSION 3.25)

function(run what)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR "wheel: ${what} failed")
  endif()
endfunction()

file(REMOVE_RECURSE "${SCRATCH}/environment")
run("making a virtual environment" "${PYTHON}" -m venv "${SCRATCH}/environment")
set(python "${SCRATCH}/environment/bin/python")
execute_process(COMMAND "${python}" -m pip install --quiet numpy mypy mitsuba RESULT_VARIABLE unreachable)
if(unreachable)
  message(STATUS "wheel: PyPI cannot be reached, nothing is tested")
  return()
endif()
# The folder of the build stays, so that a second wheel compiles what has changed.
run("pip install ./examples/python" "${python}" -m pip install
  --config-settings=build-dir=${SCRATCH}/build "${SOURCE}/examples/python")
run("a test of the installed module"
  "${CMAKE_COMMAND}" -E env --unset=PYTHONPATH --unset=GONIO_TOOL PYTHONDONTWRITEBYTECODE=1
  "${CMAKE_COMMAND}" -E chdir "${SOURCE}/tests/python" "${python}" -m unittest)
run("mypy --strict" "${python}" -m mypy --strict --cache-dir=${SCRATCH}/mypy
  "${SOURCE}/examples/python/first_program.py" "${SOURCE}/examples/python/how_sure.py")
