// Command lines that heel must refuse.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tools/heel/run_heel.h"

namespace heel::test {

struct Row {
  std::vector<std::string> arguments;
  std::string begins;  ///< the start of the line: which command refuses
  std::string names;   ///< what the line names
};

/// Each row ends with exit status 2, nothing on standard output, and one line on standard error.
inline void expect_refused(const std::vector<Row>& rows) {
  for (const Row& row : rows) {
    std::string line;
    for (const std::string& argument : row.arguments) line += " " + argument;
    SCOPED_TRACE("heel" + line);
    const Outcome outcome = run_heel(row.arguments);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_THAT(outcome.err,
                ::testing::AllOf(::testing::StartsWith(row.begins), ::testing::HasSubstr(row.names)));
  }
}

}  // namespace heel::test
