# SPDX-License-Identifier: MIT
# meshbound_shell_files(tool purpose [component]): completion scripts and a manual page, made by the tool itself once it is
# built, from its --help, and installed where shells and man look. `purpose` is what whatis says of it. Without help2man
# there are no manual pages. It runs the lines of an indented block (.IP), such as the examples, into one paragraph: sed
# puts a line break after each.
include(GNUInstallDirs)
find_program(HELP2MAN help2man)

function(meshbound_shell_files tool purpose)
  set(component ${ARGN})
  if(NOT component)
    set(component ${CMAKE_INSTALL_DEFAULT_COMPONENT_NAME})
  endif()
  set(folder ${PROJECT_BINARY_DIR}/shell)
  file(MAKE_DIRECTORY ${folder})
  foreach(shell IN ITEMS bash zsh fish)
    add_custom_command(TARGET ${tool} POST_BUILD
      COMMAND ${tool} --completion ${shell} > ${folder}/${tool}.${shell} VERBATIM)
  endforeach()
  if(HELP2MAN)
    add_custom_command(TARGET ${tool} POST_BUILD
      COMMAND ${HELP2MAN} --no-info --name=${purpose} --output=${folder}/${tool}.1 $<TARGET_FILE:${tool}>
      COMMAND sed -i "/^\\.IP$/,/^\\.[^I]/{/^[^.]/s/$/\\n.br/}" ${folder}/${tool}.1 VERBATIM)
  endif()
  if(MESHBOUND_INSTALL)
    install(FILES ${folder}/${tool}.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME ${tool}
      COMPONENT ${component})
    install(FILES ${folder}/${tool}.zsh DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions RENAME _${tool}
      COMPONENT ${component})
    install(FILES ${folder}/${tool}.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d
      COMPONENT ${component})
    install(FILES ${folder}/${tool}.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT ${component} OPTIONAL)
  endif()
endfunction()
