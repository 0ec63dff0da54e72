# The target `docs`: the page of ao.h, in docs/html of the build folder. Only where doxygen is installed.
find_program(OBSCURA_DOXYGEN doxygen)
configure_file(${CMAKE_CURRENT_LIST_DIR}/Doxyfile.in ${PROJECT_BINARY_DIR}/Doxyfile @ONLY)
if(OBSCURA_DOXYGEN AND PROJECT_IS_TOP_LEVEL)
  add_custom_target(docs COMMAND ${OBSCURA_DOXYGEN} ${PROJECT_BINARY_DIR}/Doxyfile
    COMMENT "Writing ${PROJECT_BINARY_DIR}/docs/html/index.html" VERBATIM)
endif()
