# Compiler settings every target shares. Link `heel_options` privately to get them.
find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  set(CMAKE_C_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
  # Without the sloppiness it caches nothing that uses precompiled headers. What another checkout of the same source has
  # compiled is taken: only the paths in debug information differ.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros
    CCACHE_BASEDIR=${CMAKE_SOURCE_DIR} CCACHE_NOHASHDIR=1 ${CCACHE_PROGRAM})
endif()

# Every configuration links some sixty test programs, mold each in a third of the time. What is installed is linked by
# the distribution's linker.
find_program(MOLD_PROGRAM mold)
if(MOLD_PROGRAM AND HEEL_BUILD_TESTS AND NOT CMAKE_CROSSCOMPILING)
  add_link_options(-fuse-ld=mold)
endif()

# A program loads the libraries that it calls, and not all that its rooms may use.
add_link_options(-Wl,--as-needed)

add_library(heel_options INTERFACE)
target_compile_options(heel_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor -Werror
  # GCC 12 warns of overlap in "text" + std::string that is not there (GCC bug 105651).
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
  # Fused multiply-add would make results depend on the instruction set.
  -ffp-contract=off)

# All presets but debug join the sources of every target (CMAKE_UNITY_BUILD): the same code, built in half the time.
if(CMAKE_UNITY_BUILD)
  target_compile_options(heel_options INTERFACE -Wno-subobject-linkage)  # meant for headers; joined sources look like one
endif()

# Of the undefined-behaviour sanitizer, the checks of every pointer before its use are left out: with Eigen's templates
# they double the compile time, and what they find the address sanitizer finds (but misaligned access).
if(HEEL_SANITIZE)
  add_compile_options(-fsanitize=${HEEL_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  if(HEEL_SANITIZE MATCHES "undefined")
    add_compile_options(-fno-sanitize=null,alignment,object-size,vptr)
  endif()
  add_link_options(-fsanitize=${HEEL_SANITIZE})
endif()

# Counters shared by threads are updated atomically; joined sources are named by their full paths.
if(HEEL_COVERAGE)
  add_compile_options(--coverage -fprofile-update=atomic -fprofile-abs-path)
  add_link_options(--coverage)
endif()

# clangd reads compile_commands.json at the root.
if(HEEL_LINK_COMPILE_COMMANDS)
  file(RELATIVE_PATH commands ${CMAKE_SOURCE_DIR} ${CMAKE_BINARY_DIR}/compile_commands.json)
  file(CREATE_LINK ${commands} ${CMAKE_SOURCE_DIR}/compile_commands.json SYMBOLIC)
endif()

# Everything under a fuzz target reports its coverage to the fuzzer.
if(HEEL_BUILD_FUZZERS)
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()
