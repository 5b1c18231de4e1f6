# The libraries for other programs: libheel-vision.a (with libheel-core.a) and libheel-arcos.a, their public headers, a
# CMake package and pkg-config files. All of it is the install component "dev", the Debian package libheel-dev.
#   find_package(heel COMPONENTS vision arcos)   → heel::vision, heel::arcos
#   pkg-config --cflags --libs heel-vision heel-arcos
include(CMakePackageConfigHelpers)

# heel_install_library(TARGET EXPORT_SET): TARGET heel_NAME becomes libheel-NAME.a and heel::NAME.
function(heel_install_library target set)
  string(REGEX REPLACE "^heel_" "" name ${target})
  set_target_properties(${target} PROPERTIES OUTPUT_NAME heel-${name} EXPORT_NAME ${name})
  target_compile_features(${target} PUBLIC cxx_std_20)
  install(TARGETS ${target} EXPORT ${set} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev)
endfunction()

heel_install_library(heel_core heel-vision)
heel_install_library(heel_vision heel-vision)
heel_install_library(heel_arcos heel-arcos)
install(DIRECTORY ${CMAKE_SOURCE_DIR}/include/heel ${CMAKE_SOURCE_DIR}/firmware-protocol/include/arcos
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev FILES_MATCHING PATTERN "*.h")

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/heel)
foreach(set heel-vision heel-arcos)
  install(EXPORT ${set} NAMESPACE heel:: FILE ${set}-targets.cmake DESTINATION ${package_dir} COMPONENT dev)
endforeach()
write_basic_package_version_file(${CMAKE_BINARY_DIR}/heelConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_SOURCE_DIR}/cmake/heelConfig.cmake ${CMAKE_BINARY_DIR}/heelConfigVersion.cmake
  DESTINATION ${package_dir} COMPONENT dev)

# The files name the installed tree relative to themselves, so that it can be installed to any prefix.
set(pkgconfig_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH HEEL_PREFIX_FROM_PKGCONFIG /prefix/${pkgconfig_dir} /prefix)
foreach(name heel-vision heel-arcos)
  configure_file(${CMAKE_SOURCE_DIR}/cmake/${name}.pc.in ${CMAKE_BINARY_DIR}/${name}.pc @ONLY)
  install(FILES ${CMAKE_BINARY_DIR}/${name}.pc DESTINATION ${pkgconfig_dir} COMPONENT dev)
endforeach()
