// Bad input to `heel simulate`, `heel experiment` and `heel report` is refused in one line that names what
// is wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "support/test_data.h"
#include "tools/heel/refusals.h"
#include "tools/heel/run_heel.h"

namespace heel {
namespace {

using test::expect_refused;
using test::Outcome;
using test::run_heel;
using ::testing::AllOf;
using ::testing::HasSubstr;

struct BadFolders {
  BadFolders() {
    test::write_text(at("words.txt"), "no folder\n");
    std::filesystem::create_directory(at("empty"));
    std::filesystem::create_directories(at("no pairs/oxford"));
  }
  std::string at(const std::string& name) const { return folder.file(name); }

  test::TemporaryFolder folder;
};

TEST(BadRun, OfSimulateIsRefused) {
  const BadFolders f;
  expect_refused({
      {{"simulate", f.at("s.toml"), "--seed", "-1"},
       "heel simulate: ",
       "--seed: '-1' (expected a whole number, 0 or more)"},
      {{"simulate", f.at("s.toml"), "--seed", "1.5"},
       "heel simulate: ",
       "--seed: '1.5' (expected a whole number"},
      {{"simulate", f.at("s.toml"), "--seed", "18446744073709551616"},
       "heel simulate: ",
       "(expected a whole number, 0…18446744073709551615)"},
      {{"simulate", f.at("s.toml"), "--duration", "0"},
       "heel simulate: ",
       "--duration: '0' (expected seconds, more than 0)"},
      {{"simulate", f.at("s.toml"), "--duration", "-1"},
       "heel simulate: ",
       "--duration: '-1' (expected seconds"},
      {{"simulate", f.at("s.toml"), "--duration", "nan"},
       "heel simulate: ",
       "--duration: 'nan' (expected seconds"},
  });
}

TEST(BadRun, OfExperimentIsRefused) {
  const BadFolders f;
  const auto experiment = [&](std::vector<std::string> more) {
    more.insert(more.begin(), "experiment");
    more.insert(more.end(), {"-o", f.at("out")});
    return more;
  };
  const std::string absent = f.at("absent"), empty = f.at("empty");
  expect_refused({
      {experiment({"real", "--data", absent}),
       "heel experiment: ", "absent: no such folder (expected one that holds oxford/ and person/)"},
      {experiment({"real", "--data", f.at("words.txt")}), "heel experiment: ", "words.txt: no such folder"},
      {experiment({"real", "--data", empty}), "heel experiment: ", "empty: no real pictures in this folder"},
      {experiment({"real", "--data", f.at("no pairs")}),
       "heel experiment: ", "no pairs: no pairs in oxford/"},
      {experiment({"stills", "--seed", "-1"}), "heel experiment: ", "--seed: '-1' (expected a whole number"},
      {experiment({"foreign", "--data", absent}),
       "heel experiment: ", "absent: no such folder (expected one that holds foreign/)"},
      {experiment({"foreign-false", "--data", empty}),
       "heel experiment: ", "empty: no foreign set in this folder (expected one that holds foreign/)"},
      {experiment({"foreign", "--foreign-set", absent}),
       "heel experiment: ", "--foreign-set " + absent + ": no such folder (expected one that holds images/"},
      {experiment({"foreign", "--foreign-set", empty}),
       "heel experiment: ", "empty/camera.yaml: cannot read"},
  });
}

TEST(BadRun, NamesAFolderThatCannotBeMadeOrRead) {
  const BadFolders f;
  const std::string file = f.at("words.txt"), loop = f.at("loop");
  const std::string scenario = test::source_path("tools/heel-sim/scenarios/demo.toml");
  // Permissions do not hold for root, under which this test may run. This fails for every user.
  std::filesystem::create_symlink("loop", loop);
  const std::string not_made =
      file + ": cannot make this folder: Not a directory (expected a folder, not a file)";
  const std::string not_read = loop + ": Too many levels of symbolic links (expected a file or folder";
  expect_refused({
      {{"experiment", "yaw", "-o", file}, "heel experiment: ", not_made},
      {{"simulate", scenario, "-o", file}, "heel simulate: ", not_made},
      {{"simulate", scenario, test::source_path("tools/heel-sim/scenarios/small_picture.toml"), "-o", file},
       "heel simulate: ",
       not_made},
      {{"fit", file, "--walk", scenario, "-o", f.at("model.toml")}, "heel fit: ", not_made},
      {{"simulate", loop}, "heel simulate: ", not_read},
      {{"pose", loop, "--template", "t.heel", "--camera-info", "c.yaml"},
       "heel pose: ",
       "t.heel: cannot read"},
      {{"report", loop}, "heel report: ", loop},
  });
}

TEST(GoodRun, PicturesAbsentFromTheDefaultFolderAreSkipped) {
  const BadFolders f;
  setenv("HEEL_TEST_DATA", f.at("absent").c_str(), /*overwrite=*/1);
  const Outcome outcome = run_heel({"experiment", "real", "foreign", "-o", f.at("out")});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("SKIPPED where absent"), HasSubstr("SKIPPED: no ")));
}

}  // namespace
}  // namespace heel
