# SPDX-License-Identifier: MIT
# The npm package beside a native build, where Emscripten is installed: the preset wasm in its own folder, build-wasm/,
# which all native builds of a checkout share. MESHBOUND_NPM is then the folder of the package, and the target npm_package
# builds it; else the variable is empty. It is no part of a build for a sanitizer.
option(MESHBOUND_WASM "Build the npm package, which reports hold as well, where Emscripten is" ${PROJECT_IS_TOP_LEVEL})
find_program(EMXX_PROGRAM em++)
mark_as_advanced(EMXX_PROGRAM)
set(MESHBOUND_NPM "")
if(NOT MESHBOUND_WASM OR NOT EMXX_PROGRAM OR MESHBOUND_SANITIZE)
  return()
endif()

include(ExternalProject)
include(ProcessorCount)
ProcessorCount(cores)
set(wasm_dir ${PROJECT_SOURCE_DIR}/build-wasm)
set(MESHBOUND_NPM ${wasm_dir}/npm)
set(wrapper "")
if(CMAKE_CXX_COMPILER_LAUNCHER)
  set(wrapper ${CMAKE_COMMAND} -E env EM_COMPILER_WRAPPER=${CMAKE_CXX_COMPILER_LAUNCHER})
endif()
ExternalProject_Add(npm_package
  SOURCE_DIR ${PROJECT_SOURCE_DIR}
  BINARY_DIR ${wasm_dir}
  CONFIGURE_COMMAND ${wrapper} ${CMAKE_COMMAND} -S ${PROJECT_SOURCE_DIR} --preset wasm
  BUILD_COMMAND ${wrapper} ${CMAKE_COMMAND} --build ${wasm_dir} --target npm --parallel ${cores}
  BUILD_ALWAYS ON
  BUILD_BYPRODUCTS ${MESHBOUND_NPM}/engine.js ${MESHBOUND_NPM}/engine.wasm ${MESHBOUND_NPM}/meshbound.js
    ${MESHBOUND_NPM}/options.js
  INSTALL_COMMAND "")
