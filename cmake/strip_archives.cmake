# Run by cpack before it makes the packages: CPACK_STRIP_FILES leaves static libraries as they are.
file(GLOB_RECURSE archives ${CPACK_TEMPORARY_DIRECTORY}/*.a)
foreach(archive IN LISTS archives)
  execute_process(COMMAND ${CPACK_HEEL_STRIP} --strip-unneeded --remove-section=.comment --remove-section=.note ${archive}
    COMMAND_ERROR_IS_FATAL ANY)
endforeach()
