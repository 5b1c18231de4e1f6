# heel_library(NAME DEPENDS …): a static library of every .cpp in the current folder.
function(heel_library name)
  cmake_parse_arguments(ARG "" "" "DEPENDS;PRIVATE_DEPENDS" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS *.cpp)
  if(NOT sources)
    return()
  endif()
  add_library(${name} STATIC ${sources})
  target_include_directories(${name} PUBLIC ${CMAKE_SOURCE_DIR}/include ${CMAKE_SOURCE_DIR}/src)
  target_link_libraries(${name} PUBLIC ${ARG_DEPENDS} PRIVATE heel_options ${ARG_PRIVATE_DEPENDS})
  heel_precompiled(${name})
endfunction()

# heel_compile_alone(FILES …): never joined with others, because their names or macros would meet.
function(heel_compile_alone)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# heel_test(NAME SOURCES … DEPENDS … [SERIAL] [THREADS] [AS_ONE ENTRY]): a GoogleTest program; each of its tests is
# a ctest entry.
# SERIAL: its tests run in real time and are not to share the machine with others.
# THREADS: what it tests runs in several threads. The thread sanitizer's preset leaves the others out
# (HEEL_ONLY_THREADED_TESTS): one thread races with nobody, at fifty times the price.
# AS_ONE: all its tests are one entry of that name, because they share what took long to make.
# Tests that need ../shared-style data find it in HEEL_TEST_DATA and call GTEST_SKIP() without it.
function(heel_test name)
  cmake_parse_arguments(ARG "SERIAL;THREADS" "TIMEOUT;AS_ONE" "SOURCES;DEPENDS;LABELS" ${ARGN})
  if(NOT HEEL_BUILD_TESTS)
    return()
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 120)
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_include_directories(${name} PRIVATE ${CMAKE_SOURCE_DIR}/tests)
  target_link_libraries(${name} PRIVATE heel_options ${ARG_DEPENDS} GTest::gmock GTest::gtest_main)
  # What is tested keeps its optimisation and is compiled file by file; the tests are joined, which halves their build.
  if(NOT CMAKE_BUILD_TYPE STREQUAL Debug)
    target_compile_options(${name} PRIVATE -O1 -Wno-subobject-linkage)
    set_target_properties(${name} PROPERTIES UNITY_BUILD ON)
    heel_compile_alone(${CMAKE_SOURCE_DIR}/tests/allocation_count.cpp)  # takes the C library's place
    heel_precompiled_test(${name})
  endif()
  if(HEEL_ONLY_THREADED_TESTS AND NOT ARG_THREADS)
    set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL ON)
    return()
  endif()
  add_dependencies(heel_tests ${name})
  set(properties TIMEOUT ${ARG_TIMEOUT} RUN_SERIAL ${ARG_SERIAL})
  if(ARG_LABELS)
    list(APPEND properties LABELS "${ARG_LABELS}")
  endif()
  if(ARG_AS_ONE)
    add_test(NAME ${ARG_AS_ONE} COMMAND ${name})
    set_tests_properties(${ARG_AS_ONE} PROPERTIES ${properties} SKIP_REGULAR_EXPRESSION "\\[  SKIPPED \\]")
  else()
    gtest_discover_tests(${name} PROPERTIES ${properties} DISCOVERY_TIMEOUT 60)
  endif()
endfunction()
