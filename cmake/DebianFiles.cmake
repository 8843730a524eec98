# SPDX-License-Identifier: MIT
# Run by CPack before the packages are made: what Debian asks of each package besides what is installed anywhere else.
set(stamp "Sun, 22 Nov 2026 00:00:00 +0000")
foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER ${component} upper)
  set(name ${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
  set(root ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/${component}/usr)
  set(doc ${root}/share/doc/${name})
  file(MAKE_DIRECTORY ${doc})
  file(COPY_FILE ${CPACK_MESHBOUND_PACKAGING}/copyright ${doc}/copyright)
  file(WRITE ${doc}/changelog "${name} (${CPACK_PACKAGE_VERSION}) unstable; urgency=medium\n\n"
    "  * What changed is in CHANGELOG.md of the sources.\n\n -- ${CPACK_PACKAGE_CONTACT}  ${stamp}\n")
  execute_process(COMMAND gzip -9nf ${doc}/changelog COMMAND_ERROR_IS_FATAL ANY)
  file(GLOB pages ${root}/share/man/man1/*.1)
  foreach(page IN LISTS pages)
    execute_process(COMMAND gzip -9nf ${page} COMMAND_ERROR_IS_FATAL ANY)
  endforeach()
  if(component STREQUAL "tools")
    file(MAKE_DIRECTORY ${root}/share/lintian/overrides)
    file(COPY_FILE ${CPACK_MESHBOUND_PACKAGING}/lintian-overrides ${root}/share/lintian/overrides/${name})
    file(REMOVE_RECURSE ${doc}/LICENSES)  # the texts of the copyright file
  endif()
endforeach()
