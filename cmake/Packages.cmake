# SPDX-License-Identifier: MIT
# Debian packages: `cpack -G DEB` in a built tree makes meshbound (tools and documents), libmeshbound-c1, libmeshbound-dev
# and, where they were built, meshbound-mpi (the tools that run over MPI) and python3-meshbound.
set(MESHBOUND_PACKAGE_CONTACT "The meshbound authors <meshbound@users.noreply.github.com>" CACHE STRING
  "Name and address in the packages")
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME meshbound)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "mesh simplification with a proven error bound")
set(CPACK_PACKAGE_CONTACT ${MESHBOUND_PACKAGE_CONTACT})
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/DebianFiles.cmake)
set(CPACK_MESHBOUND_PACKAGING ${PROJECT_SOURCE_DIR}/packaging)
set(promise "For an original mesh A and a simplified mesh M, the symmetric Hausdorff
distance of what was written to disk is proven to lie between two bounds,
rounding errors included.")

# meshbound_package(component name section text depends): what one package is called, says and needs.
macro(meshbound_package component name section text depends)
  list(APPEND CPACK_COMPONENTS_ALL ${component})
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section})
  set(CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS "${depends}")
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${promise}\n.\n${text}")
endmacro()

meshbound_package(tools meshbound graphics
  "This package holds the command-line tools, their documents and schemas." "")
if(TARGET meshbound_c)
  get_target_property(c_abi meshbound_c SOVERSION)
  meshbound_package(c libmeshbound-c${c_abi} libs
    "This package holds the shared library." "")
  set(CPACK_DEBIAN_C_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/packaging/triggers)
  set(c_library "libmeshbound-c${c_abi} (= ${PROJECT_VERSION}), ")
endif()
if(MESHBOUND_HAS_DRACO)
  set(draco_package ", libdraco-dev")
endif()
meshbound_package(dev libmeshbound-dev libdevel
  "This package holds the headers, the static libraries for C++, found by CMake,\nand what programs in C link to, found by CMake and pkg-config."
  "${c_library}libeigen3-dev, libgmp-dev${draco_package}")
set(CPACK_DEBIAN_DEV_PACKAGE_RECOMMENDS "libcgal-dev, libopenmpi-dev")
if(TARGET meshbound_mpi)
  meshbound_package(mpi meshbound-mpi graphics
    "This package holds the command-line tools that work on one mesh over many\nprocesses of MPI." "openmpi-bin")
endif()
if(TARGET meshbound_python)
  meshbound_package(python python3-meshbound python
    "This package holds the Python package." "python3, python3-numpy")
endif()
include(CPack)
