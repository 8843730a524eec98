# SPDX-License-Identifier: MIT
# Run by CTest: installs the build into a fresh prefix, then builds the C example against it in the two ways that a C
# project has, pkg-config and find_package, and runs what came out. Also looks at what the library exports.
function(run step)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE errors)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${step} failed (${result}):\n${output}${errors}")
  endif()
  message(STATUS "${step}: done")
  set(output "${output}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${work_dir})
run("install" ${CMAKE_COMMAND} --install ${build_dir} --prefix ${work_dir}/prefix --config ${config})
file(GLOB_RECURSE pc ${work_dir}/prefix/meshbound_c.pc)
get_filename_component(pc_dir "${pc}" DIRECTORY)
get_filename_component(lib_dir "${pc_dir}" DIRECTORY)
if(NOT EXISTS ${lib_dir}/libmeshbound_c.so.${abi})
  message(FATAL_ERROR "${lib_dir}/libmeshbound_c.so.${abi} was not installed")
endif()

if(sanitize)
  set(flags -fsanitize=${sanitize})
endif()
set(ENV{PKG_CONFIG_PATH} ${pc_dir})
run("ask pkg-config" ${pkg_config} --cflags --libs meshbound_c)
separate_arguments(pc_flags UNIX_COMMAND "${output}")
run("compile with pkg-config" ${compiler} -std=c99 -Wall -Wextra -Werror ${example} -o ${work_dir}/by_pkg_config
  ${pc_flags} ${flags} -lm -Wl,-rpath,${lib_dir})
run("run it" ${work_dir}/by_pkg_config)

run("configure with find_package" ${CMAKE_COMMAND} -S ${consumer_dir} -B ${work_dir}/build -G ${generator}
  -D CMAKE_C_COMPILER=${compiler} -D CMAKE_PREFIX_PATH=${work_dir}/prefix -D EXAMPLE=${example}
  -D "CMAKE_C_FLAGS=${flags}")
run("build with find_package" ${CMAKE_COMMAND} --build ${work_dir}/build)
run("run it" ${work_dir}/build/simplify)

run("list the exports" ${nm} -D --defined-only ${lib_dir}/libmeshbound_c.so.${abi})
string(REGEX MATCHALL "[^\n]+" lines "${output}")
list(FILTER lines EXCLUDE REGEX " (mb_[a-z_]+@@MESHBOUND_C_[0-9]+|MESHBOUND_C_[0-9]+)$")
if(lines AND NOT sanitize)
  message(FATAL_ERROR "the library exports what is not part of its interface: ${lines}")
endif()
if(NOT output MATCHES "mb_simplify@@MESHBOUND_C_${abi}")
  message(FATAL_ERROR "the library does not export mb_simplify:\n${output}")
endif()
