# SPDX-License-Identifier: MIT
# Install and export: `find_package(meshbound)` gives meshbound::meshbound, with COMPONENTS cgal also meshbound::cgal.
# The GPL part has its own export file, so that a user of the MIT core neither needs CGAL nor receives GPL headers
# when it was switched off.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/meshbound)

install(TARGETS meshbound EXPORT meshboundTargets COMPONENT dev)
install(EXPORT meshboundTargets NAMESPACE meshbound:: DESTINATION ${package_dir} COMPONENT dev)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/meshbound DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev
  FILES_MATCHING PATTERN "*.h" PATTERN "cgal" EXCLUDE PATTERN "mpi.h" EXCLUDE)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/LICENSES ${PROJECT_SOURCE_DIR}/docs ${PROJECT_SOURCE_DIR}/tools/schema
  ${PROJECT_SOURCE_DIR}/examples DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})

if(TARGET meshbound_cgal)
  set_target_properties(meshbound_cgal PROPERTIES EXPORT_NAME cgal)
  install(TARGETS meshbound_cgal EXPORT meshboundCgalTargets COMPONENT dev)
  install(EXPORT meshboundCgalTargets NAMESPACE meshbound:: DESTINATION ${package_dir} COMPONENT dev)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/meshbound/cgal DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/meshbound
    COMPONENT dev FILES_MATCHING PATTERN "*.h")
endif()

if(TARGET meshbound_mpi)
  set_target_properties(meshbound_mpi PROPERTIES EXPORT_NAME mpi)
  install(TARGETS meshbound_mpi EXPORT meshboundMpiTargets COMPONENT dev)
  install(EXPORT meshboundMpiTargets NAMESPACE meshbound:: DESTINATION ${package_dir} COMPONENT dev)
  install(FILES ${PROJECT_SOURCE_DIR}/include/meshbound/mpi.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/meshbound
    COMPONENT dev)
endif()

# The C interface: <meshbound.h> beside the folder of C++ headers; found by pkg-config, or as the component c, which needs
# nothing of the C++ library.
if(TARGET meshbound_c)
  install(TARGETS meshbound_c EXPORT meshboundCTargets LIBRARY COMPONENT c NAMELINK_COMPONENT dev)
  install(EXPORT meshboundCTargets NAMESPACE meshbound:: DESTINATION ${package_dir} COMPONENT dev)
  install(FILES ${PROJECT_SOURCE_DIR}/bindings/c/include/meshbound.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
    COMPONENT dev)
  # Relative to its own place, so that a prefix may be chosen at install time, and moved.
  file(RELATIVE_PATH pc_to_prefix ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
  configure_file(${PROJECT_SOURCE_DIR}/bindings/c/meshbound_c.pc.in ${PROJECT_BINARY_DIR}/meshbound_c.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/meshbound_c.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT dev)
endif()

# Where Debian's Python looks; only when the component python is asked for, since pip installs the package elsewhere.
if(TARGET meshbound_python)
  set(python_dir lib/python3/dist-packages/meshbound)
  install(TARGETS meshbound_python LIBRARY DESTINATION ${python_dir} COMPONENT python EXCLUDE_FROM_ALL)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/bindings/python/meshbound/ DESTINATION ${python_dir} COMPONENT python
    EXCLUDE_FROM_ALL FILES_MATCHING PATTERN "*.py" PATTERN "*.pyi" PATTERN "py.typed")
endif()

foreach(tool IN ITEMS simplify_with_bound lod_chain hausdorff_distance penetration_depth verify_certificate generate_mesh)
  if(TARGET ${tool})
    install(TARGETS ${tool} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  endif()
endforeach()

# In a package of their own: the other tools need no MPI.
foreach(tool IN ITEMS simplify_with_bound_mpi hausdorff_distance_mpi)
  if(TARGET ${tool})
    install(TARGETS ${tool} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT mpi)
  endif()
endforeach()

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/meshboundConfig.cmake.in
  ${PROJECT_BINARY_DIR}/meshboundConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/meshboundConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/meshboundConfig.cmake ${PROJECT_BINARY_DIR}/meshboundConfigVersion.cmake
  DESTINATION ${package_dir} COMPONENT dev)
