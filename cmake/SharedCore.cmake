# SPDX-License-Identifier: MIT
# meshbound_link_core(target): links the core into a shared library or module. Such a library shares the OpenMP of its
# process, while the programs of this build may have one linked statically (cmake/StaticLibraries.cmake); so the archive
# itself is linked here instead of the target, whose link interface names that one.
function(meshbound_link_core target)
  target_compile_features(${target} PRIVATE cxx_std_20)
  target_compile_options(${target} PRIVATE -ffp-contract=off -fno-fast-math)
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/include)
  if(BUILD_SHARED_LIBS)
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:meshbound::meshbound>)
    return()
  endif()
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:Eigen3::Eigen> $<BUILD_INTERFACE:$<TARGET_FILE:meshbound>>)
  if(MESHBOUND_HAS_DRACO)
    target_link_libraries(${target} PRIVATE ${DRACO_LIBRARY})
  endif()
  target_link_options(${target} PRIVATE ${OpenMP_CXX_FLAGS})
  add_dependencies(${target} meshbound)
endfunction()
