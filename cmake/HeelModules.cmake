# heel_shared_module(TARGET FILE SOURCES … LIBRARIES …): FILE.so beside the programs, loaded by
# src/shared_module. SOURCES are below src/. They are compiled again where a room has them, because a shared object
# needs position-independent code, which the programs do without.
file(RELATIVE_PATH HEEL_MODULES_FROM_PROGRAMS ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR}/heel)
function(heel_shared_module target file)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES" ${ARGN})
  list(TRANSFORM ARG_SOURCES PREPEND ${CMAKE_SOURCE_DIR}/src/)
  add_library(${target} MODULE ${ARG_SOURCES})
  target_include_directories(${target} PRIVATE ${CMAKE_SOURCE_DIR}/include ${CMAKE_SOURCE_DIR}/src)
  target_link_libraries(${target} PRIVATE heel_options fmt::fmt Threads::Threads ${ARG_LIBRARIES})
  # A source that is missing here shows when it is linked, not when it is loaded. (A sanitizer's symbols are the program's.)
  if(NOT HEEL_SANITIZE)
    target_link_options(${target} PRIVATE -Wl,--no-undefined)
  endif()
  set_target_properties(${target} PROPERTIES PREFIX "" OUTPUT_NAME ${file} CXX_VISIBILITY_PRESET hidden
    VISIBILITY_INLINES_HIDDEN ON
    LIBRARY_OUTPUT_DIRECTORY ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/${HEEL_MODULES_FROM_PROGRAMS})
  install(TARGETS ${target} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/heel)
endfunction()
