// Paths of the source tree and of the test data. The test data are real images and a real video. They are not
// part of heel: they are in the folder HEEL_TEST_DATA, or in ../shared/data beside the source tree.
#pragma once

#include <string>

namespace heel::test {

/// A file or folder of the source tree: source_path("config/heel.toml").
std::string source_path(const std::string& relative);

/// A file or folder of the test data, whether it exists or not. Without an argument: the folder of all test
/// data.
std::string data_path(const std::string& relative = "");

bool has_data(const std::string& relative);

/// True under HEEL_REQUIRE_DATA=1: then a test without its data fails; otherwise it is skipped.
bool data_is_required();

/// A line in the test's output, by which tools/test knows that a test has used the data.
void print_data_use(const std::string& relative);

/// Why a test that needs this file or folder of the test data cannot run.
std::string absent_data_message(const std::string& relative);

}  // namespace heel::test

/// In a test's body or in SetUp(): ends the test where this file or folder of the test data is missing. The
/// test is then skipped, or failed under HEEL_REQUIRE_DATA=1.
#define HEEL_NEEDS_TEST_DATA(relative)                                        \
  do {                                                                        \
    if (::heel::test::has_data(relative)) {                                   \
      ::heel::test::print_data_use(relative);                                 \
      break;                                                                  \
    }                                                                         \
    const std::string heel_why = ::heel::test::absent_data_message(relative); \
    if (::heel::test::data_is_required()) GTEST_FAIL() << heel_why;           \
    GTEST_SKIP() << heel_why;                                                 \
  } while (false)
