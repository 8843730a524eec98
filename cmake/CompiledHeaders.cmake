# SPDX-License-Identifier: MIT
# Headers of other projects that nearly all files of a folder include, compiled once: without them most of the time of a
# build goes into reading the same headers hundreds of times. None of our own, so that a change of one compiles again only
# what includes it.

# Compiler caches as launchers cannot cache what is compiled with them; whoever has one builds often, file by file.
if(CMAKE_CXX_COMPILER_LAUNCHER OR DEFINED ENV{EM_COMPILER_WRAPPER})
  set(MESHBOUND_FIRST_BUILD OFF)
else()
  set(MESHBOUND_FIRST_BUILD ON)
endif()
option(MESHBOUND_PRECOMPILED_HEADERS "Compile the common headers of other projects once" ${MESHBOUND_FIRST_BUILD})
if(PROJECT_IS_TOP_LEVEL)
  option(CMAKE_UNITY_BUILD "Compile several files of a folder as one" ${MESHBOUND_FIRST_BUILD})
  set(CMAKE_UNITY_BUILD_BATCH_SIZE 16 CACHE STRING "The largest number of files that are compiled as one")
endif()

# GCC collects garbage less often: 7 to 10% of its time for a fifth more memory. It takes the files that are compiled as
# one for headers, in which private types should not be members of others.
if(CMAKE_UNITY_BUILD)
  add_compile_options(
    "$<$<COMPILE_LANG_AND_ID:CXX,GNU>:--param=ggc-min-heapsize=500000;-Wno-subobject-linkage>")
endif()

set(MESHBOUND_STANDARD_HEADERS <algorithm> <array> <atomic> <cmath> <cstdint> <filesystem> <fstream> <functional>
  <limits> <map> <memory> <numeric> <optional> <span> <sstream> <string> <string_view> <thread> <unordered_map> <utility>
  <variant> <vector> <Eigen/Geometry> ${CMAKE_CURRENT_LIST_DIR}/compiled_types.h)

# Only headers whose time is spent in reading them belong here: GCC compiles again, for each file, inline functions of
# classes with virtual ones and templates that the headers themselves instantiate.

# meshbound_compile_headers(name LIBRARIES libraries... [OPTIONS options...] [HEADERS headers...]): the standard headers
# and these, compiled once for targets with the same options and libraries.
function(meshbound_compile_headers name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "LIBRARIES;OPTIONS;HEADERS")
  if(NOT MESHBOUND_PRECOMPILED_HEADERS)
    return()
  endif()
  file(CONFIGURE OUTPUT ${name}.cpp CONTENT "")
  add_library(${name} OBJECT ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
  target_link_libraries(${name} PRIVATE meshbound::meshbound ${arg_LIBRARIES})
  target_compile_options(${name} PRIVATE ${arg_OPTIONS})
  target_precompile_headers(${name} PRIVATE ${MESHBOUND_STANDARD_HEADERS} ${arg_HEADERS})
endfunction()

# meshbound_use_headers(name targets...): the targets use the headers of meshbound_compile_headers(name).
function(meshbound_use_headers name)
  if(TARGET ${name})
    foreach(target IN LISTS ARGN)
      target_precompile_headers(${target} REUSE_FROM ${name})
    endforeach()
  endif()
endfunction()
