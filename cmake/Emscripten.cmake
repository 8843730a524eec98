# SPDX-License-Identifier: MIT
# WebAssembly: one thread, and files in memory alone. Stands in for what a native build finds.
add_library(meshbound_one_thread INTERFACE)
add_library(OpenMP::OpenMP_CXX ALIAS meshbound_one_thread)
target_include_directories(meshbound_one_thread INTERFACE ${PROJECT_SOURCE_DIR}/bindings/js/compat)
# Warnings that only mean that a size has 32 bits, or that there are no pragmas of OpenMP.
target_compile_options(meshbound_warnings INTERFACE -Wno-unknown-pragmas -Wno-sign-conversion -Wno-shorten-64-to-32
  -Wno-unused-parameter -Wno-unused-variable)
# Vectors of 128 bits, whose arithmetic is that of IEEE doubles; relaxed ones would not be.
set(MESHBOUND_COMPILER_HAS_AVX2 OFF CACHE INTERNAL "AVX2 is no part of WebAssembly")
set(MESHBOUND_COMPILER_HAS_AVX512 OFF CACHE INTERNAL "nor is AVX-512")
set(compat ${PROJECT_SOURCE_DIR}/bindings/js/compat/standard_library.h)
add_compile_options(-include ${compat} -fwasm-exceptions -msimd128)
add_link_options(-fwasm-exceptions)

# Headers alone, which may not bring the rest of /usr/include with them.
set(meshbound_headers ${PROJECT_BINARY_DIR}/headers)
file(MAKE_DIRECTORY ${meshbound_headers})
foreach(header IN ITEMS nlohmann/json.hpp fast_float/fast_float.h)
  cmake_path(GET header PARENT_PATH folder)
  find_path(${folder}_dir ${header} PATHS /usr/include NO_DEFAULT_PATH NO_CMAKE_FIND_ROOT_PATH REQUIRED)
  file(CREATE_LINK ${${folder}_dir}/${folder} ${meshbound_headers}/${folder} SYMBOLIC)
endforeach()

# meshbound_core_of_npm(target): leaves out what the npm package does not offer, and so what needs GMP.
function(meshbound_core_of_npm target)
  get_target_property(sources ${target} SOURCES)
  set(folders numeric geometry mesh bvh proof distance simplify certificate levels attributes)
  list(JOIN folders "|" folders)
  list(FILTER sources INCLUDE REGEX "^(${folders})/")
  set_target_properties(${target} PROPERTIES SOURCES
    "${sources};report/worst_spot.cpp;${PROJECT_SOURCE_DIR}/bindings/js/compat/to_chars.cpp")
  target_include_directories(${target} SYSTEM PRIVATE ${meshbound_headers})
endfunction()
