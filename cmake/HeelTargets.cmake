# heel_compile_alone(FILES …): never joined with others, because their names or macros would meet.
function(heel_compile_alone)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# heel_test(NAME [SOURCES …] DEPENDS … [PROGRAMS …] [COUNTS_ALLOCATIONS] [REAL_TIME] [SERIAL] [THREADS] [MEASURES]
# [MEASURING_TESTS …] [AS_ONE ENTRY]): a GoogleTest program of every .cpp in the current folder, or of SOURCES; each of its tests is a ctest entry.
# PROGRAMS: heel, heeld, heel-sim: the built programs it runs, by test::built_program (support/process.h).
# COUNTS_ALLOCATIONS: links support/allocation_count.cpp, which takes the place of the C library's malloc.
# REAL_TIME: its tests run in real time: no two such tests at once.
# SERIAL: its tests must not be late at all: they do not share the machine with any other.
# THREADS: what it tests runs in several threads. The thread sanitizer's preset leaves the others out
# (HEEL_ONLY_THREADED_TESTS): one thread races with nobody, at fifty times the price.
# MEASURES: tests of the drawn world and of what measures in it. The sanitizers' presets leave these out, and what runs
# the command heel (HEEL_COMMAND_TESTS): they see what drives the robot, and the libraries.
# MEASURING_TESTS: the same for single tests of a program that is kept, names with * between colons.
# AS_ONE: all its tests are one entry of that name, because they share what took long to make.
# A test ends itself when what it waits for does not come (support/process.h); ctest ends one that hangs, long after
# a machine under load would be done: after 600 s, or TIMEOUT.
# Tests that need real images or video say so by HEEL_NEEDS_TEST_DATA (support/test_data.h).
function(heel_test name)
  cmake_parse_arguments(ARG "REAL_TIME;SERIAL;THREADS;MEASURES;COUNTS_ALLOCATIONS" "TIMEOUT;AS_ONE;MEASURING_TESTS" "SOURCES;DEPENDS;LABELS;PROGRAMS" ${ARGN})
  if(NOT HEEL_BUILD_TESTS)
    return()
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 600)
  endif()
  if(NOT ARG_SOURCES)
    file(GLOB ARG_SOURCES CONFIGURE_DEPENDS *.cpp)
  endif()
  if(ARG_COUNTS_ALLOCATIONS)
    list(APPEND ARG_SOURCES ${CMAKE_SOURCE_DIR}/tests/support/allocation_count.cpp)
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_include_directories(${name} PRIVATE ${CMAKE_SOURCE_DIR}/tests)
  target_link_libraries(${name} PRIVATE heel_options heel_test_support ${ARG_DEPENDS} GTest::gmock GTest::gtest_main)
  foreach(program IN LISTS ARG_PROGRAMS)
    add_dependencies(${name} ${program})
  endforeach()
  # What is tested keeps its optimisation and is compiled file by file; the tests are joined, which halves their build.
  if(NOT CMAKE_BUILD_TYPE STREQUAL Debug)
    # Paths relative to the source, so that ccache takes what another checkout has compiled.
    target_compile_options(${name} PRIVATE -O1 -Wno-subobject-linkage -fmacro-prefix-map=${CMAKE_SOURCE_DIR}/=)
    set_target_properties(${name} PROPERTIES UNITY_BUILD ON)
    heel_compile_alone(${CMAKE_SOURCE_DIR}/tests/support/allocation_count.cpp)  # takes the C library's place
    heel_precompiled_test(${name})
  endif()
  # What is tested keeps its checks of undefined behaviour; in the tests' own code they double the time to build it.
  if(HEEL_SANITIZE MATCHES undefined)
    # With the address sanitizer alone GCC 12 warns of std::regex (GCC bug 105562).
    target_compile_options(${name} PRIVATE -fno-sanitize=undefined $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  endif()
  # Golden results are compared where they are made, in release.
  if(NOT HEEL_COMMAND_TESTS AND (ARG_MEASURES OR "heel" IN_LIST ARG_PROGRAMS OR "golden" IN_LIST ARG_LABELS))
    set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL ON)
    return()
  endif()
  if(HEEL_ONLY_THREADED_TESTS AND NOT ARG_THREADS)
    set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL ON)
    return()
  endif()
  add_dependencies(heel_tests ${name})
  set(properties TIMEOUT ${ARG_TIMEOUT} RUN_SERIAL ${ARG_SERIAL})
  if(ARG_REAL_TIME)
    list(APPEND properties RESOURCE_LOCK real_time)
  endif()
  # ctest starts those of the highest cost first. What runs one after the other, or long, starts before what can fill
  # the gaps beside it.
  if(ARG_REAL_TIME OR ARG_AS_ONE)
    list(APPEND properties COST 100)
  endif()
  if(ARG_LABELS)
    list(APPEND properties LABELS "${ARG_LABELS}")
  endif()
  if(ARG_AS_ONE)
    add_test(NAME ${ARG_AS_ONE} COMMAND ${name})
    # ctest ignores the exit status of a test that it takes for skipped, but after failures GoogleTest lists these last.
    set_tests_properties(${ARG_AS_ONE} PROPERTIES ${properties} SKIP_REGULAR_EXPRESSION "\\[  SKIPPED \\][^[]*$")
  else()
    set(filter)
    if(NOT HEEL_COMMAND_TESTS AND ARG_MEASURING_TESTS)
      set(filter TEST_FILTER -${ARG_MEASURING_TESTS})
    endif()
    gtest_discover_tests(${name} ${filter} PROPERTIES ${properties} DISCOVERY_TIMEOUT 300)
  endif()
endfunction()

# heel_python_test(NAME FILE [LABELS …] [TIMEOUT …]): the unittest cases of a Python file, as one ctest entry. They test
# scripts and what is installed: sanitizers and line counters see nothing of them. Debian's own Python runs them, for
# which tools/setup installs numpy; another one in PATH has none.
function(heel_python_test name file)
  if(HEEL_SANITIZE OR HEEL_COVERAGE)
    return()
  endif()
  cmake_parse_arguments(ARG "" "TIMEOUT" "LABELS" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 600)
  endif()
  add_test(NAME ${name} COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/${file} -v)
  set_tests_properties(${name} PROPERTIES TIMEOUT ${ARG_TIMEOUT} LABELS "${ARG_LABELS}"
    SKIP_REGULAR_EXPRESSION "OK [(]skipped=" ENVIRONMENT
    "PYTHONDONTWRITEBYTECODE=1;HEEL_SOURCE_DIR=${CMAKE_SOURCE_DIR};HEEL_BUILD_DIR=${CMAKE_BINARY_DIR};HEEL_CMAKE=${CMAKE_COMMAND};HEEL_CXX=${CMAKE_CXX_COMPILER}")
endfunction()
