# SPDX-License-Identifier: MIT
# The target docs_api: an HTML reference of the public headers, in the build folder under api/html. Part of no other
# target; only where Doxygen is found. It fails, and so does the test that builds it, when a public name has no
# documentation or one that Doxygen objects to.
find_package(Doxygen QUIET)
if(NOT DOXYGEN_FOUND)
  return()
endif()
set(DOXYGEN_PROJECT_NUMBER ${PROJECT_VERSION})
set(DOXYGEN_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/api)
set(DOXYGEN_STRIP_FROM_PATH ${PROJECT_SOURCE_DIR}/include)
set(DOXYGEN_GENERATE_LATEX NO)
set(DOXYGEN_FILE_PATTERNS *.h)
# The first sentence of a comment is its summary; std::span and the like need no pages of ours.
set(DOXYGEN_JAVADOC_AUTOBRIEF YES)
set(DOXYGEN_BUILTIN_STL_SUPPORT YES)
set(DOXYGEN_EXCLUDE_SYMBOLS *::detail)
set(DOXYGEN_QUIET YES)
set(DOXYGEN_WARN_NO_PARAMDOC NO)
set(DOXYGEN_WARN_IF_INCOMPLETE_DOC NO)
set(DOXYGEN_WARN_AS_ERROR FAIL_ON_WARNINGS)
doxygen_add_docs(docs_api ${PROJECT_SOURCE_DIR}/include COMMENT "API reference in ${PROJECT_BINARY_DIR}/api/html")
if(MESHBOUND_TESTS)
  add_test(NAME api_reference_test COMMAND ${CMAKE_COMMAND} --build ${PROJECT_BINARY_DIR} --target docs_api)
endif()
