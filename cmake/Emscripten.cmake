# SPDX-License-Identifier: MIT
# WebAssembly: one thread, and no files. Stands in for what a native build finds.
add_library(meshbound_one_thread INTERFACE)
add_library(OpenMP::OpenMP_CXX ALIAS meshbound_one_thread)
target_include_directories(meshbound_one_thread INTERFACE ${PROJECT_SOURCE_DIR}/bindings/js/compat)
# Warnings that only mean that a size has 32 bits, or that there are no pragmas of OpenMP.
target_compile_options(meshbound_warnings INTERFACE -Wno-unknown-pragmas -Wno-sign-conversion -Wno-shorten-64-to-32
  -Wno-unused-parameter -Wno-unused-variable)
# Vectors of 128 bits, whose arithmetic is that of IEEE doubles; relaxed ones would not be.
set(MESHBOUND_COMPILER_HAS_AVX2 OFF CACHE INTERNAL "AVX2 is no part of WebAssembly")
set(compat ${PROJECT_SOURCE_DIR}/bindings/js/compat/standard_library.h)
add_compile_options(-include ${compat} -fwasm-exceptions -msimd128)
add_link_options(-fwasm-exceptions)

# meshbound_without_files(target): leaves out what reads and writes files or knows their attributes, and what needs
# GMP.
function(meshbound_without_files target)
  file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/headers)
  get_target_property(sources ${target} SOURCES)
  set(folders numeric geometry bvh proof distance simplify certificate levels)
  list(JOIN folders "|" folders)
  set(files mesh/line_mesh mesh/mesh_summary mesh/mesh_view mesh/weld mesh/transform
    mesh/gltf_nodes)
  list(JOIN files "|" files)
  list(FILTER sources INCLUDE REGEX "^(${folders})/|^(${files})[.]cpp$")
  # Headers alone, which may not bring the rest of /usr/include with them.
  find_path(nlohmann_dir nlohmann/json.hpp PATHS /usr/include NO_DEFAULT_PATH NO_CMAKE_FIND_ROOT_PATH REQUIRED)
  file(CREATE_LINK ${nlohmann_dir}/nlohmann ${PROJECT_BINARY_DIR}/headers/nlohmann SYMBOLIC)
  set_source_files_properties(levels/scene_run.cpp mesh/gltf_nodes.cpp PROPERTIES
     INCLUDE_DIRECTORIES ${PROJECT_BINARY_DIR}/headers)
  set_target_properties(${target} PROPERTIES SOURCES "${sources};report/worst_spot.cpp")
endfunction()
