# SPDX-License-Identifier: MIT
# Install and export: `find_package(meshbound)` gives meshbound::meshbound, with COMPONENTS cgal also meshbound::cgal.
# The GPL part has its own export file, so that a user of the MIT core neither needs CGAL nor receives GPL headers
# when it was switched off.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/meshbound)

install(TARGETS meshbound EXPORT meshboundTargets)
install(EXPORT meshboundTargets NAMESPACE meshbound:: DESTINATION ${package_dir})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/meshbound DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  FILES_MATCHING PATTERN "*.h" PATTERN "cgal" EXCLUDE)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/LICENSES ${PROJECT_SOURCE_DIR}/docs ${PROJECT_SOURCE_DIR}/tools/schema
  ${PROJECT_SOURCE_DIR}/examples DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})

if(TARGET meshbound_cgal)
  set_target_properties(meshbound_cgal PROPERTIES EXPORT_NAME cgal)
  install(TARGETS meshbound_cgal EXPORT meshboundCgalTargets)
  install(EXPORT meshboundCgalTargets NAMESPACE meshbound:: DESTINATION ${package_dir})
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/meshbound/cgal DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/meshbound
    FILES_MATCHING PATTERN "*.h")
endif()

foreach(tool IN ITEMS simplify_with_bound lod_chain hausdorff_distance penetration_depth verify_certificate generate_mesh)
  if(TARGET ${tool})
    install(TARGETS ${tool} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  endif()
endforeach()

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/meshboundConfig.cmake.in
  ${PROJECT_BINARY_DIR}/meshboundConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/meshboundConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/meshboundConfig.cmake ${PROJECT_BINARY_DIR}/meshboundConfigVersion.cmake
  DESTINATION ${package_dir})
