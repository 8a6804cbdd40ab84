# cmake -D TOOL=gonio -P cmake/directions.cmake: writes the designed sets of points in examples/data/directions, for the
# shipped prior and the usual apparatus. examples/data/directions/README.md states the origin of the other sets.
cmake_minimum_required(VERSION 3.25)
cmake_path(GET CMAKE_CURRENT_LIST_DIR PARENT_PATH source)
set(folder "${source}/examples/data/directions")

function(write_set name)
  message("${name}")
  execute_process(COMMAND "${TOOL}" design ${ARGN} -o "${folder}/${name}.csv" COMMAND_ERROR_IS_FATAL ANY OUTPUT_QUIET)
endfunction()

foreach(count IN ITEMS 1 2 5 8 10 16 20)
  write_set(point-${count}-perceived -n ${count})
endforeach()
write_set(point-5-first -n 5 --search exchange)
foreach(count IN ITEMS 1 2 5 10 20)
  write_set(point-${count}-expected-error -n ${count} --criterion expected-error --search exchange)
endforeach()
# The other sets of images come from `gonio-papers directions --write`, whose versions of these two exceed the usual
# apparatus.
foreach(fixed IN ITEMS camera light)
  write_set(fixed-${fixed}-25-3-expected-error
    -n 3 --geometry fixed-${fixed} --fov 25 --criterion expected-error --search exchange --in-sample)
endforeach()
