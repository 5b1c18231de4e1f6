# Where sources are joined (every preset but debug), the headers most of them need are read once and kept
# precompiled: what the compiler then has to do is ours. debug, without it, shows what a file forgot to include.
# heel_precompiled(TARGET): those of the program. heel_precompiled_test(TARGET): with GoogleTest's (heel_test_headers,
# made beside the tests), and compiled as tests are. heel_precompiled_command(TARGET): with those of a command line, which
# only calls libraries: it is optimised less, which takes half the time to build.
function(heel_precompiled_headers name)
  file(CONFIGURE OUTPUT ${name}.cpp CONTENT "// Carries the precompiled headers.\n")
  add_library(${name} OBJECT ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
  target_link_libraries(${name} PRIVATE heel_options Eigen3::Eigen)
  target_precompile_headers(${name} PRIVATE
    <algorithm> <array> <cmath> <cstdint> <filesystem> <fstream> <functional> <memory> <numbers> <optional> <span>
    <string> <vector> <Eigen/Core> <Eigen/Geometry> <Eigen/LU> ${ARGN})
endfunction()

function(heel_use_headers target headers)
  if(CMAKE_UNITY_BUILD)
    target_precompile_headers(${target} REUSE_FROM ${headers})
  endif()
endfunction()

function(heel_precompiled target)
  heel_use_headers(${target} heel_headers)
endfunction()

function(heel_precompiled_command target)
  if(NOT CMAKE_BUILD_TYPE STREQUAL Debug)
    target_compile_options(${target} PRIVATE -O1)
  endif()
  heel_use_headers(${target} heel_command_headers)
endfunction()

function(heel_precompiled_test target)
  heel_use_headers(${target} heel_test_headers)
endfunction()

if(CMAKE_UNITY_BUILD)
  # With them GCC 12 forgets that "text" + std::string, where it sees reading and writing beyond the end (GCC bug
  # 105651), stands in a system header. debug keeps these warnings. ccache asks for the first.
  target_compile_options(heel_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess;-Wno-array-bounds;-Wno-stringop-overflow;-Wno-stringop-overread>)
  heel_precompiled_headers(heel_headers)
  heel_precompiled_headers(heel_command_headers <CLI/CLI.hpp> <fmt/format.h> <nlohmann/json.hpp>)
  target_link_libraries(heel_command_headers PRIVATE CLI11::CLI11 fmt::fmt nlohmann_json::nlohmann_json)
  target_compile_options(heel_command_headers PRIVATE -O1)
endif()
