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
# Everything that the README names runs from the prefix.
foreach(tool IN ITEMS simplify_with_bound lod_chain hausdorff_distance penetration_depth verify_certificate generate_mesh)
  run("run the installed ${tool}" ${work_dir}/prefix/bin/${tool} --version)
endforeach()
foreach(file IN ITEMS README.md schema/simplify-1.schema.json schema/certificate-1.md examples/simplify_in_memory.cpp)
  if(NOT EXISTS ${work_dir}/prefix/share/doc/meshbound/${file})
    message(FATAL_ERROR "share/doc/meshbound/${file} was not installed")
  endif()
endforeach()
foreach(file IN ITEMS bash-completion/completions/lod_chain zsh/site-functions/_lod_chain
    fish/vendor_completions.d/lod_chain.fish)
  if(NOT EXISTS ${work_dir}/prefix/share/${file})
    message(FATAL_ERROR "share/${file} was not installed")
  endif()
endforeach()
run("configure the consumer" ${CMAKE_COMMAND} -S ${consumer_dir} -B ${work_dir}/build -G ${generator}
  -D CMAKE_BUILD_TYPE=${config} -D CMAKE_CXX_COMPILER=${compiler} -D CMAKE_PREFIX_PATH=${work_dir}/prefix
  -D CONSUMER_CGAL=${with_cgal} -D CONSUMER_MPI=${with_mpi} ${flags})
execute_process(COMMAND ${CMAKE_COMMAND} -S ${consumer_dir} -B ${work_dir}/wrong -G ${generator}
  -D CMAKE_CXX_COMPILER=${compiler} -D CMAKE_PREFIX_PATH=${work_dir}/prefix -D CONSUMER_COMPONENT=CGAL
  RESULT_VARIABLE result OUTPUT_QUIET ERROR_VARIABLE output)
string(REGEX REPLACE "[ \n]+" " " output "${output}")
if(result EQUAL 0 OR NOT output MATCHES "it has no component CGAL; its components are meshbound, cgal, mpi and c")
  message(FATAL_ERROR "a component that is not there: no reason given (${result}):\n${output}")
endif()
run("build the consumer" ${CMAKE_COMMAND} --build ${work_dir}/build)
run("run the consumer" ${work_dir}/build/consumer)
if(with_cgal)
  run("run the consumer of the cgal component" ${work_dir}/build/simplify)
endif()
if(with_mpi)
  # One rank, for which MPI needs no mpirun.
  run("run the consumer of the mpi component" ${work_dir}/build/simplify_over_ranks)
endif()
