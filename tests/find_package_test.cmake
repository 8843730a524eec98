# SPDX-License-Identifier: MIT
# Run by CTest: installs the build into a fresh prefix, then configures, builds and runs tests/consumer against it.
function(run step)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${step} failed (${result}):\n${output}")
  endif()
  message(STATUS "${step}: done")
endfunction()

file(REMOVE_RECURSE ${work_dir})
if(sanitize)
  set(flags -D CMAKE_CXX_FLAGS=-fsanitize=${sanitize})
endif()
run("install" ${CMAKE_COMMAND} --install ${build_dir} --prefix ${work_dir}/prefix --config ${config})
run("configure the consumer" ${CMAKE_COMMAND} -S ${consumer_dir} -B ${work_dir}/build -G ${generator}
  -D CMAKE_BUILD_TYPE=${config} -D CMAKE_CXX_COMPILER=${compiler} -D CMAKE_PREFIX_PATH=${work_dir}/prefix
  -D CONSUMER_CGAL=${with_cgal} ${flags})
run("build the consumer" ${CMAKE_COMMAND} --build ${work_dir}/build)
run("run the consumer" ${work_dir}/build/consumer)
if(with_cgal)
  run("run the consumer of the cgal component" ${work_dir}/build/simplify)
endif()
