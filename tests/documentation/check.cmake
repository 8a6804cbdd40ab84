# The first C++ block of the README is the program that is compiled as examples/teaching/first_program.cpp.
cmake_minimum_required(VERSION 3.25)
file(READ "${SOURCE}/README.md" readme)
file(READ "${SOURCE}/examples/teaching/first_program.cpp" program)
string(FIND "${readme}" "```cpp\n${program}```\n" place)
if(place EQUAL -1)
  message(FATAL_ERROR "README.md does not show examples/teaching/first_program.cpp as it is")
endif()
