# SPDX-License-Identifier: MIT
# Our own compiler settings: `meshbound_warnings` is linked as $<BUILD_INTERFACE:...>, so no consumer inherits them.
option(MESHBOUND_WERROR "Treat warnings in our own code as errors (set by the dev, asan and tsan presets)" OFF)
set(MESHBOUND_SANITIZE "" CACHE STRING "Sanitizers for every target, as in -fsanitize=<value>: address,undefined or thread")

add_library(meshbound_warnings INTERFACE)
target_compile_options(meshbound_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
  $<$<BOOL:${MESHBOUND_WERROR}>:-Werror>
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>  # GCC 12 warns falsely inside std::string (GCC bug 105651)
  $<$<CXX_COMPILER_ID:Clang>:-Wno-unused-result>)  # GoogleTest's EXPECT_THROW drops results on purpose

# Directory-wide on purpose: a sanitizer works only when every object of the program, GoogleTest's mains included, has it.
if(MESHBOUND_SANITIZE)
  # With the checks of a sanitizer in between, GCC 12 takes much of CGAL and Eigen for uninitialised.
  target_compile_options(meshbound_warnings INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  add_compile_options(-fsanitize=${MESHBOUND_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${MESHBOUND_SANITIZE})
endif()
