# Shared by the library's build and the projects beside it (shape/, mpi/, examples/papers/, examples/learn/). Such a
# project is built within the library's build, or alone with an installed gonio (alone.cmake).
cmake_path(GET CMAKE_CURRENT_LIST_DIR PARENT_PATH gonio_source)

if(PROJECT_IS_TOP_LEVEL AND NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Debug, Release, RelWithDebInfo or MinSizeRel" FORCE)
endif()
# Use ccache if it is installed.
find_program(GONIO_CCACHE ccache)
mark_as_advanced(GONIO_CCACHE)
if(PROJECT_IS_TOP_LEVEL AND GONIO_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # Let ccache store files compiled with a precompiled header, and ignore the header's time.
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND}" -E env CCACHE_SLOPPINESS=pch_defines,time_macros "${GONIO_CCACHE}")
endif()
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)

# Position-independent code, because shared libraries such as the Python module may link ours, and programs share the
# precompiled header. Functions of ours are never replaced when a program starts, so compilers may inline them.
if(PROJECT_IS_TOP_LEVEL)
  add_compile_options(-fPIC -fno-semantic-interposition)
endif()

# gonio_add_part(NAME LIBRARY...): adds gonio::NAME, for the headers that need these libraries.
function(gonio_add_part name)
  add_library(gonio_${name} INTERFACE)
  add_library(gonio::${name} ALIAS gonio_${name})
  set_target_properties(gonio_${name} PROPERTIES EXPORT_NAME ${name})
  target_link_libraries(gonio_${name} INTERFACE gonio::gonio ${ARGN})
endfunction()

# gonio_add_compiled(NAME HEADER_ONLY SOURCE...): adds a library of the bodies that HEADER_ONLY's headers otherwise
# include, static or shared by BUILD_SHARED_LIBS. Its users see only declarations.
function(gonio_add_compiled name header_only)
  add_library(gonio_${name} ${ARGN})
  add_library(gonio::${name} ALIAS gonio_${name})
  set_target_properties(gonio_${name} PROPERTIES EXPORT_NAME ${name} VERSION 0.2.0 SOVERSION 0.2)
  target_compile_definitions(gonio_${name} PUBLIC GONIO_COMPILED)
  target_link_libraries(gonio_${name} PUBLIC ${header_only} PRIVATE
    $<BUILD_INTERFACE:gonio_warnings> $<BUILD_INTERFACE:gonio_native>)
  if(NOT name STREQUAL "compiled")
    target_link_libraries(gonio_${name} PUBLIC gonio::compiled)
  endif()
  gonio_precompile(gonio_${name})
endfunction()

# gonio_precompile(TARGET): precompiles the headers that nearly all sources include, which would cost each source 1.5 s.
# The first target that asks compiles them for all.
function(gonio_precompile target)
  get_property(first GLOBAL PROPERTY gonio_precompiled)
  if(first AND NOT BUILD_SHARED_LIBS)
    target_precompile_headers(${target} REUSE_FROM ${first})
    return()
  endif()
  set_property(GLOBAL PROPERTY gonio_precompiled ${target})
  target_precompile_headers(${target} PRIVATE
    <Eigen/Core> <gonio/core/arrays.hpp> <algorithm> <array> <cmath> <filesystem> <functional> <memory> <numbers>
    <optional> <random> <span> <string> <utility> <vector>)
endfunction()

# gonio_install_part(NAME): installs each target in its own export set: a user without the libraries of one part can use
# the others.
include(GNUInstallDirs)
function(gonio_install_part name)
  if(NOT gonio_package_dir) # GONIO_INSTALL is off
    return()
  endif()
  foreach(target IN ITEMS ${name} compiled_${name})
    if(TARGET gonio_${target})
      install(TARGETS gonio_${target} EXPORT gonio_${target}Targets)
      install(EXPORT gonio_${target}Targets NAMESPACE gonio:: DESTINATION "${gonio_package_dir}")
    endif()
  endforeach()
endfunction()

# gonio_add_executables(): adds gonio_executables, which our own executables link: the library and each part found.
function(gonio_add_executables)
  add_library(gonio_executables INTERFACE)
  target_link_libraries(gonio_executables INTERFACE $<IF:$<TARGET_EXISTS:gonio::compiled>,gonio::compiled,gonio::gonio>)
  foreach(part IN ITEMS image exr tiff exif scattered)
    if(gonio_has_${part})
      gonio_link(gonio_executables ${part})
    endif()
  endforeach()
endfunction()

# gonio_link(TARGET PART...): links gonio::PART, in its compiled form if there is one.
function(gonio_link target)
  foreach(part IN LISTS ARGN)
    if(TARGET gonio::compiled_${part})
      set(part compiled_${part})
    endif()
    get_target_property(type ${target} TYPE)
    set(how PRIVATE)
    if(type STREQUAL "INTERFACE_LIBRARY")
      set(how INTERFACE)
    endif()
    target_link_libraries(${target} ${how} gonio::${part})
  endforeach()
endfunction()

add_library(gonio_warnings INTERFACE)
# The warnings that are off for g++ are false in g++ 12: for joined strings and Eigen's copies (gcc bug 105651 and
# similar), and for its own AVX-512 intrinsics (bug 105593), which GONIO_NATIVE may use. Clang and the sanitizers find
# such errors instead.
target_compile_options(gonio_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Werror
  -Wshadow -Wconversion -Wno-sign-conversion -Wold-style-cast -Wcast-align
  -Wnon-virtual-dtor -Woverloaded-virtual -Wextra-semi
  $<$<CXX_COMPILER_ID:GNU>:-Wduplicated-cond -Wlogical-op -Wno-restrict -Wno-array-bounds
    -Wno-stringop-overflow -Wno-maybe-uninitialized -Wno-uninitialized>)

# Never for gonio::gonio: -march=native would change the alignment, and so the ABI, of a user's Eigen types.
option(GONIO_NATIVE "Compile our own executables for this machine's processor" OFF)
add_library(gonio_native INTERFACE)
if(GONIO_NATIVE)
  target_compile_options(gonio_native INTERFACE -march=native)
endif()
