# `cpack` makes a .deb that installs on Debian 12; tools/package configures for it. The maintainer scripts stand in
# systemd/debian/.
set(HEEL_MAINTAINER "heel maintainers <heel@localhost>" CACHE STRING "Who answers for the package: Name <address>")
# The date of the commit, so that the same commit makes the same package.
execute_process(COMMAND git -C ${CMAKE_SOURCE_DIR} log -1 --format=%cD
  OUTPUT_VARIABLE HEEL_PACKAGE_DATE OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT HEEL_PACKAGE_DATE)
  string(TIMESTAMP HEEL_PACKAGE_DATE "%a, %d %b %Y %H:%M:%S +0000" UTC)
endif()

configure_file(systemd/debian/changelog.in changelog @ONLY)
find_program(GZIP_PROGRAM gzip REQUIRED)
execute_process(COMMAND ${GZIP_PROGRAM} -9nf ${CMAKE_BINARY_DIR}/changelog COMMAND_ERROR_IS_FATAL ANY)
install(FILES ${CMAKE_BINARY_DIR}/changelog.gz DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES README.md systemd/debian/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES systemd/debian/lintian-overrides DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides RENAME heel)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME heel)
set(CPACK_PACKAGE_VENDOR heel)
set(CPACK_PACKAGE_CONTACT "${HEEL_MAINTAINER}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Pioneer P3-AT follows one person, by the back of the shirt")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"One camera watches the back of one person's shirt; the plane fitted
through it says where the person is and which way they are about to walk,
and the robot follows that direction.
.
The package holds the daemon heeld and its service, the operator's command
heel, and heel-sim, a simulated robot, person and camera. The service is
neither enabled nor started: that is for a person beside the robot.")
set(CPACK_PACKAGING_INSTALL_PREFIX ${CMAKE_INSTALL_PREFIX})
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION misc)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "systemd")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3-matplotlib, udev, v4l-utils")
set(packaging ${CMAKE_SOURCE_DIR}/systemd/debian)
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA
  ${packaging}/postinst ${packaging}/prerm ${packaging}/postrm ${packaging}/conffiles)
include(CPack)
