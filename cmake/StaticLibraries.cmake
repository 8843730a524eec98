# SPDX-License-Identifier: MIT
# Which libraries the programs of this build link statically. Half of the time that a tool takes for two small meshes is
# the loading of shared libraries. What is installed for `find_package` does not depend on any of this.
include(CheckCXXSourceCompiles)
include(CheckLinkerFlag)

# GCC's OpenMP: the tools set its environment before it starts (tools/common/omp_spin.h), which must stand in the program
# itself for that. Not for a shared meshbound, whose code must be position-independent.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND NOT BUILD_SHARED_LIBS)
  execute_process(COMMAND ${CMAKE_CXX_COMPILER} -print-file-name=libgomp.a
    OUTPUT_VARIABLE static_libgomp OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(IS_ABSOLUTE "${static_libgomp}")
    set(OpenMP_gomp_LIBRARY ${static_libgomp} CACHE FILEPATH "GCC's OpenMP, linked statically" FORCE)
  endif()
endif()

# Everything, the C library included, where there is a static one of each. Sanitizers need shared libraries.
set(CMAKE_REQUIRED_FLAGS -fopenmp)
set(CMAKE_REQUIRED_LINK_OPTIONS -static)
check_cxx_source_compiles("
  #include <omp.h>
  #include <iostream>
  #include <thread>
  int main() { std::thread([] { std::cout << omp_get_max_threads(); }).join(); }" MESHBOUND_CAN_LINK_STATICALLY)
unset(CMAKE_REQUIRED_FLAGS)
unset(CMAKE_REQUIRED_LINK_OPTIONS)
find_library(MESHBOUND_STATIC_GMP libgmp.a)
find_library(MESHBOUND_STATIC_GMPXX libgmpxx.a)
find_library(MESHBOUND_STATIC_MPFR libmpfr.a)
find_library(MESHBOUND_STATIC_DRACO libdraco.a)
find_library(MESHBOUND_STATIC_PNG libpng.a)
find_library(MESHBOUND_STATIC_ZLIB libz.a)
mark_as_advanced(MESHBOUND_STATIC_GMP MESHBOUND_STATIC_GMPXX MESHBOUND_STATIC_MPFR MESHBOUND_STATIC_PNG
  MESHBOUND_STATIC_ZLIB MESHBOUND_STATIC_DRACO)
set(static_tools_possible OFF)
if(MESHBOUND_CAN_LINK_STATICALLY AND OpenMP_gomp_LIBRARY MATCHES "[.]a$" AND MESHBOUND_STATIC_GMP
    AND MESHBOUND_STATIC_GMPXX AND MESHBOUND_STATIC_MPFR AND MESHBOUND_STATIC_PNG AND MESHBOUND_STATIC_ZLIB
    AND NOT MESHBOUND_SANITIZE)
  set(static_tools_possible ON)
endif()
option(MESHBOUND_STATIC_TOOLS "Link the tools statically, so that they start in half the time" ${static_tools_possible})

# CGAL and our own targets find these in the cache.
if(MESHBOUND_STATIC_TOOLS)
  foreach(variable IN ITEMS GMP_LIBRARY GMP_LIBRARY_RELEASE GMP_LIBRARY_DEBUG GMP_LIBRARIES)
    set(${variable} ${MESHBOUND_STATIC_GMP} CACHE FILEPATH "GMP, linked statically" FORCE)
  endforeach()
  foreach(variable IN ITEMS GMPXX_LIBRARY GMPXX_LIBRARIES)
    set(${variable} ${MESHBOUND_STATIC_GMPXX} CACHE FILEPATH "The C++ part of GMP, linked statically" FORCE)
  endforeach()
  set(MPFR_LIBRARIES ${MESHBOUND_STATIC_MPFR} CACHE FILEPATH "MPFR, linked statically" FORCE)
  if(MESHBOUND_STATIC_DRACO)
    set(DRACO_LIBRARY ${MESHBOUND_STATIC_DRACO} CACHE FILEPATH "Draco, linked statically" FORCE)
  endif()
endif()

check_linker_flag(CXX -Wl,--no-warnings MESHBOUND_LINKER_CAN_BE_QUIET)

# meshbound_tool(target): a program that is linked as the tools are.
function(meshbound_tool target)
  if(MESHBOUND_STATIC_TOOLS)
    # libgomp could load plugins for accelerators, which nothing here uses; linkers that can be told do not warn of it.
    target_link_options(${target} PRIVATE -static $<$<BOOL:${MESHBOUND_LINKER_CAN_BE_QUIET}>:-Wl,--no-warnings>)
  endif()
endfunction()
