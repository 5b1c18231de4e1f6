# Everything heel stands on; all of it is in Debian 12.
find_package(Threads REQUIRED)
find_package(PkgConfig REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(CLI11 REQUIRED)
find_package(ZLIB REQUIRED)
find_package(yaml-cpp REQUIRED)
find_package(JPEG REQUIRED)
find_package(PNG REQUIRED)
find_package(Boost 1.74 REQUIRED)  # headers only: Beast and Asio
pkg_check_modules(HWY REQUIRED IMPORTED_TARGET libhwy)
pkg_check_modules(SERIALPORT REQUIRED IMPORTED_TARGET libserialport)
# FFmpeg's libraries: OpenCV's reader of videos loses time stamps and display matrices.
pkg_check_modules(LIBAV REQUIRED IMPORTED_TARGET libavformat libavcodec libswscale libavutil)
pkg_check_modules(SYSTEMD REQUIRED IMPORTED_TARGET libsystemd)
pkg_check_modules(PROMETHEUS REQUIRED IMPORTED_TARGET prometheus-cpp-core)
pkg_check_modules(NLOPT REQUIRED IMPORTED_TARGET nlopt)
pkg_check_modules(ZSTD REQUIRED IMPORTED_TARGET libzstd)
# Paho's client for MQTT, with TLS. Debian's has no pkg-config file, and its CMake package wants OpenSSL's headers too.
find_path(PAHO_INCLUDE_DIR MQTTClient.h REQUIRED)
find_library(PAHO_LIBRARY paho-mqtt3cs REQUIRED)
add_library(paho UNKNOWN IMPORTED)
set_target_properties(paho PROPERTIES
  IMPORTED_LOCATION ${PAHO_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${PAHO_INCLUDE_DIR})
option(HEEL_WITH_LIBCAMERA "Cameras through libcamera, where it is installed" ON)
if(HEEL_WITH_LIBCAMERA)
  pkg_check_modules(LIBCAMERA IMPORTED_TARGET libcamera)
endif()

# Debian's OpenCVConfig.cmake comes only with all of OpenCV (VTK and GDAL included); the modules used here
# are found by name instead, so that a robot computer need not carry the rest.
find_path(OPENCV_INCLUDE_DIR opencv2/core.hpp PATH_SUFFIXES opencv4 REQUIRED)
foreach(module core imgproc imgcodecs videoio calib3d features2d)
  find_library(OPENCV_${module}_LIBRARY opencv_${module} REQUIRED)
  add_library(opencv_${module} UNKNOWN IMPORTED)
  set_target_properties(opencv_${module} PROPERTIES
    IMPORTED_LOCATION ${OPENCV_${module}_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${OPENCV_INCLUDE_DIR})
endforeach()

# Highway picks the instruction set at run time, so that no -m option is needed anywhere. What it has for x86-64
# processors older than SSSE3 (2006) is EMU128: loops over four lanes, which the compiler makes SSE2 of. Highway
# 1.0 replaces it by one-lane code on GCC before 12.3 because of GCC bug 106322, wrong code for the high half of
# vectorised integer products; heel multiplies no integers for their high half, and the tests hold EMU128's
# results to those of every other set.
target_compile_definitions(PkgConfig::HWY INTERFACE HWY_BROKEN_EMU128=0)
# 64-bit ARM: NEON alone, which all of them have. This is Highway's switch for "nothing to pick at run time". With
# the choice come SVE, whose vector size the code would have to do without knowing, and NEON for processors with
# AES instructions only, which leaves out the Raspberry Pi 4.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64|arm64")
  target_compile_definitions(PkgConfig::HWY INTERFACE TOOLCHAIN_MISS_SYS_AUXV_H)
endif()
