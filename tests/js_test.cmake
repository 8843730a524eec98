# SPDX-License-Identifier: MIT
# Run by CTest: tests the npm package of this build in Node and Chromium against the native tools.
find_program(NODE node)
if(NOT npm OR NOT NODE)
  message("js_test: Skipped\nthe build has no npm package: Emscripten is missing, tools/install_dependencies --wasm installs it")
  return()
endif()
set(ENV{MESHBOUND_NPM} ${npm})
set(ENV{MESHBOUND_TOOLS} ${tools})
set(ENV{MESHBOUND_GENERATOR} ${generator})
execute_process(COMMAND ${NODE} --test ${source_dir}/bindings/js/test/ WORKING_DIRECTORY ${source_dir}
  RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "${output}")
endif()
