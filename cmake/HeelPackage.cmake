# `cpack` makes two packages that install on Debian 12; tools/package configures for them. The maintainer scripts stand
# in systemd/debian/.
#   heel          programs, service, configuration (install component "heel")
#   libheel-dev   libraries and headers for other programs (component "dev"): a package of its own, as Debian does it,
#                 because a robot computer needs neither them nor Eigen's and Highway's headers, and because a program
#                 that uses SURF or ARCOS needs no daemon
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
install(FILES ${CMAKE_BINARY_DIR}/changelog.gz systemd/debian/copyright
  DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/libheel-dev COMPONENT dev)

set(CPACK_GENERATOR DEB)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL heel dev)
set(CPACK_PACKAGE_NAME heel)
set(CPACK_PACKAGE_VENDOR heel)
set(CPACK_PACKAGE_CONTACT "${HEEL_MAINTAINER}")
set(CPACK_PACKAGING_INSTALL_PREFIX ${CMAKE_INSTALL_PREFIX})
set(CPACK_STRIP_FILES ON)
set(CPACK_HEEL_STRIP ${CMAKE_STRIP})
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_SOURCE_DIR}/cmake/strip_archives.cmake)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)

set(CPACK_DEBIAN_HEEL_PACKAGE_NAME heel)
set(CPACK_DEBIAN_HEEL_PACKAGE_SECTION misc)
set(CPACK_DEBIAN_HEEL_DESCRIPTION
"Pioneer P3-AT follows one person, by the back of the shirt
One camera watches the back of one person's shirt; the plane fitted
through it says where the person is and which way they are about to walk,
and the robot follows that direction.
.
The package holds the daemon heeld and its service, the operator's command
heel, and heel-sim, a simulated robot, person and camera. The service is
neither enabled nor started: that is for a person beside the robot.")
set(CPACK_DEBIAN_HEEL_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_HEEL_PACKAGE_DEPENDS "systemd, libjs-dygraphs")
set(CPACK_DEBIAN_HEEL_PACKAGE_RECOMMENDS "python3-matplotlib, udev, v4l-utils")
set(packaging ${CMAKE_SOURCE_DIR}/systemd/debian)
set(CPACK_DEBIAN_HEEL_PACKAGE_CONTROL_EXTRA
  ${packaging}/postinst ${packaging}/prerm ${packaging}/postrm ${packaging}/conffiles)

set(CPACK_DEBIAN_DEV_PACKAGE_NAME libheel-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_DESCRIPTION
"SURF features, pose from a plane, and ARCOS packets for C++20
Static libraries, headers, a CMake package and pkg-config files:
heel-vision has SURF-64 features with SIMD, exact matching, homographies
by RANSAC, and the motion from a plane; heel-arcos turns the bytes of
Pioneer robots' firmware into packets, and commands into bytes.")
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "libeigen3-dev (>= 3.4), libhwy-dev (>= 1.0)")
include(CPack)
