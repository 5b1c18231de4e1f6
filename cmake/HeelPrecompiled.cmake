# Where sources are joined (every preset but debug), the headers most of them need are read once and kept
# precompiled: what the compiler then has to do is ours. debug, without it, shows what a file forgot to include.
# heel_precompiled(TARGET): those of the program. heel_precompiled_test(TARGET): with GoogleTest's (heel_test_headers,
# made beside the tests), and compiled as tests are.
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

function(heel_precompiled_test target)
  heel_use_headers(${target} heel_test_headers)
endfunction()

if(CMAKE_UNITY_BUILD)
  # With them GCC 12 forgets that "text" + std::string, where it sees reading and writing beyond the end (GCC bug
  # 105651), stands in a system header. debug keeps these warnings. ccache asks for the first.
  target_compile_options(heel_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess;-Wno-array-bounds;-Wno-stringop-overflow;-Wno-stringop-overread>)
  heel_precompiled_headers(heel_headers)
endif()
