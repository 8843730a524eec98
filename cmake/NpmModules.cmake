# SPDX-License-Identifier: MIT
# npm_modules(source_folder work_folder result_variable): the modules that package-lock.json in `source_folder` names,
# with the checksums in it, fetched by npm into `work_folder` when the build is configured. The variable becomes a file
# that is as old as they are, or empty where Node.js, npm or a network is missing, which is said and is no error.
find_program(NODE_PROGRAM node)
find_program(NPM_PROGRAM npm)
mark_as_advanced(NODE_PROGRAM NPM_PROGRAM)

function(npm_modules source_folder work_folder result)
  set(${result} "" PARENT_SCOPE)
  if(NOT NODE_PROGRAM OR NOT NPM_PROGRAM)
    message(STATUS "Node.js or npm is missing: ${source_folder} is left out")
    return()
  endif()
  set(lock ${source_folder}/package-lock.json)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${lock})
  file(SHA256 ${lock} checksum)
  set(installed ${work_folder}/installed-${checksum})
  if(NOT EXISTS ${installed})
    file(MAKE_DIRECTORY ${work_folder})
    file(COPY ${lock} ${source_folder}/package.json DESTINATION ${work_folder})
    execute_process(
      COMMAND ${NPM_PROGRAM} ci --ignore-scripts --no-audit --no-fund --prefer-offline --fetch-retries 1
      WORKING_DIRECTORY ${work_folder} TIMEOUT 300 RESULT_VARIABLE status OUTPUT_QUIET ERROR_VARIABLE error)
    if(NOT status EQUAL 0)
      message(WARNING "npm ci failed: ${source_folder} is left out. ${error}")
      return()
    endif()
    file(TOUCH ${installed})
  endif()
  set(${result} ${installed} PARENT_SCOPE)
endfunction()
