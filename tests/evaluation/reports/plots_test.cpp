// The program that draws figures: it is found and run; messages where it, Python or matplotlib is missing.
#include "evaluation/reports/plots.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <csignal>
#include <filesystem>

#include "evaluation/reports/run_program.h"
#include "heel/error.h"
#include "support/environment.h"
#include "support/temporary_folder.h"

namespace heel {
namespace {

using test::ScopedEnvironment;
using test::TemporaryFolder;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// A test program in place of tools/plots.
class Plots : public ::testing::Test {
 protected:
  std::string program(const std::string& text) {
    const std::string path = test::write_text(folder_.file("plots"), text);
    chmod(path.c_str(), 0755);
    return path;
  }
  std::string why_not(const std::string& text) {
    const ScopedEnvironment plots("HEEL_PLOTS", program(text));
    return evaluation::draw_figures({"a folder"});
  }

  TemporaryFolder folder_;
};

TEST_F(Plots, GetTheArgumentsUnchanged) {
  EXPECT_EQ(why_not("#!/bin/sh\n[ $# -eq 1 ] && [ \"$1\" = 'a folder' ]\n"), "");
}

TEST_F(Plots, AMissingPackageIsNamed) {
  const auto names_the_package = HasSubstr("install the Debian package python3-matplotlib");
  EXPECT_THAT(why_not("#!/bin/sh\nexit 3\n"), names_the_package) << "no matplotlib";
  EXPECT_THAT(why_not("#!/nonexistent/python3\n"), names_the_package) << "no Python";
}

TEST_F(Plots, AMissingProgramIsNamed) {
  const ScopedEnvironment plots("HEEL_PLOTS", folder_.file("absent"));
  EXPECT_THAT(evaluation::draw_figures({"x"}), HasSubstr(folder_.file("absent") + ": no such program"));
}

TEST_F(Plots, ItsErrorMessageIsPassedOn) {
  const auto message = [&](const std::string& text) -> std::string {
    try {
      return "drawn: " + why_not(text);
    } catch (const Error& error) {
      return error.what();
    }
  };
  EXPECT_EQ(message("#!/bin/sh\necho some warning >&2\necho 'plots: path.csv: empty' >&2\nexit 2\n"),
            "path.csv: empty");
  EXPECT_THAT(message("#!/bin/sh\nexit 4\n"), HasSubstr("plots: ended with status 4"));
}

TEST(RunProgram, KeepsStandardErrorAndDropsStandardOutput) {
  const auto end = evaluation::run_program(
      {"/bin/sh", "-c",
       "echo out; cat; i=0; while [ $i -lt 20000 ]; do echo line $i >&2; i=$((i+1)); done; exit 7"});
  EXPECT_EQ(end.start_error, 0);
  EXPECT_EQ(end.status, 7);
  EXPECT_THAT(end.complaints, StartsWith("line 0\nline 1\n")) << "the output is larger than a pipe's buffer";
  EXPECT_THAT(end.complaints, ::testing::EndsWith("line 19999\n"));
}

TEST(RunProgram, ReturnsTheExitStatus) {
  EXPECT_EQ(evaluation::run_program({"/bin/sh", "-c", "kill -TERM $$"}).status, -SIGTERM);
  EXPECT_EQ(evaluation::run_program({"/nonexistent/program"}).start_error, ENOENT);
}

}  // namespace
}  // namespace heel
