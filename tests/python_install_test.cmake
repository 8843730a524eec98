# SPDX-License-Identifier: MIT
# Run by CTest: installs the Python package with pip, without any network, and calls it. The compiled part comes from the
# build that is there. Also looks at what that part exports.
file(REMOVE_RECURSE ${work_dir})
# pip leaves its own build folder in the source.
file(COPY ${source_dir}/bindings/python DESTINATION ${work_dir}/source/bindings)
file(COPY ${source_dir}/CMakeLists.txt DESTINATION ${work_dir}/source)
execute_process(COMMAND ${CMAKE_COMMAND} -E env MESHBOUND_BUILD=${build_dir}
  ${python} -m pip install --no-index --no-build-isolation --no-deps --target ${work_dir}/site
  ${work_dir}/source/bindings/python RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "pip install failed (${result}):\n${output}")
endif()
execute_process(COMMAND ${CMAKE_COMMAND} -E env PYTHONPATH=${work_dir}/site ${python} -c
  "import meshbound; print(meshbound.__file__, meshbound.hausdorff_distance(([[0,0,0],[1,0,0],[0,1,0]], [[0,1,2]]), ([[0,0,1],[1,0,1],[0,1,1]], [[0,1,2]])).upper)"
  WORKING_DIRECTORY ${work_dir} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE errors)
if(NOT result EQUAL 0 OR NOT output MATCHES "^${work_dir}/site/meshbound/__init__.py 1(\\.0000|\n)")
  message(FATAL_ERROR "the installed package failed (${result}):\n${output}${errors}")
endif()
foreach(file IN ITEMS py.typed _core.pyi)
  if(NOT EXISTS ${work_dir}/site/meshbound/${file})
    message(FATAL_ERROR "meshbound/${file} was not installed")
  endif()
endforeach()

file(GLOB module ${work_dir}/site/meshbound/_core.*.so)
execute_process(COMMAND ${nm} -D --defined-only ${module} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE errors)
if(NOT result EQUAL 0 OR NOT output MATCHES "^[0-9a-f]+ T PyInit__core\n$")
  string(SUBSTRING "${output}" 0 500 output)
  message(FATAL_ERROR "${module} exports more than PyInit__core (${result}):\n${output}${errors}")
endif()
