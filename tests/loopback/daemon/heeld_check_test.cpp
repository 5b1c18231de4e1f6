// heeld's command line without a robot: --check, --print-…, and what is said about bad input.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "loopback/daemon/scene.h"
#include "support/process.h"

namespace heel::test {
namespace {

using ::testing::HasSubstr;

struct Outcome {
  int status;
  std::string output;
};

Outcome heeld(const Scene& scene, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), HEELD_PROGRAM);
  Process process(arguments, scene.path("check.log"));
  const int status = process.wait(20.0);
  return {status, process.output()};
}

constexpr int kExitConfiguration = 78;

TEST(HeeldCheck, AGoodConfigurationIsListedWithOriginsAndVerdict) {
  const Scene scene(1);
  const std::string config = scene.write_config("[gate]\nv_max_m_s = 0.5\n");
  const Outcome outcome = heeld(scene, {"--config", config, "--check"});
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("gate.v_max_m_s"));
  EXPECT_THAT(outcome.output, HasSubstr(config + ":17\n"));
  EXPECT_THAT(outcome.output, HasSubstr("# default\n"));
  EXPECT_THAT(outcome.output, HasSubstr("taken at 2.00 m"));
}

TEST(HeeldCheck, AllThatIsWrongWithAFileIsSaid) {
  const Scene scene(1);
  const std::string config = scene.write_config("[gate]\nv_max = 0.5\nseparation_m = -1\n");
  const Outcome outcome = heeld(scene, {"--config", config, "--check"});
  EXPECT_EQ(outcome.status, kExitConfiguration);
  EXPECT_EQ(outcome.output, config + ":17:1: gate.v_max: no such key; did you mean gate.v_max_m_s?\n" +
                                config + ":18:16: gate.separation_m: -1 (expected a number 0…5 m)\n");
}

TEST(HeeldCheck, FilesItRefersToAreLoaded) {
  const Scene scene(1);
  std::filesystem::remove(scene.path("shirt.heel"));
  const Outcome outcome = heeld(scene, {"--config", scene.write_config(), "--check"});
  EXPECT_EQ(outcome.status, kExitConfiguration);
  EXPECT_THAT(outcome.output, HasSubstr(scene.path("shirt.heel")));
}

TEST(HeeldCheck, BearingLimitMustFitTheCamera) {
  const Scene scene(1);
  const Outcome outcome =
      heeld(scene, {"--config", scene.write_config("[control]\nbearing_max_rad = 0.6\n"), "--check"});
  EXPECT_EQ(outcome.status, kExitConfiguration);
  EXPECT_THAT(outcome.output, HasSubstr("control.bearing_max_rad: 0.6 (expected less than"));
}

TEST(HeeldCheck, AFileReadAsFastAsPossibleIsNoCamera) {
  const Scene scene(1);
  const std::string config = scene.write_config();
  const std::string text = content_of(config);
  std::ofstream(config) << text.substr(0, 9) << "file_speed = 0\n" << text.substr(9);  // after [camera]
  const Outcome outcome = heeld(scene, {"--config", config, "--check"});
  EXPECT_EQ(outcome.status, kExitConfiguration);
  EXPECT_THAT(outcome.output, HasSubstr("camera.file_speed: 0 (expected more than 0"));
}

TEST(HeeldCheck, MissingConfigurationIsNamed) {
  const Scene scene(1);
  const Outcome outcome = heeld(scene, {"--config", "/nowhere.toml"});
  EXPECT_EQ(outcome.status, kExitConfiguration);
  EXPECT_THAT(outcome.output, HasSubstr("/nowhere.toml: cannot read"));
  EXPECT_EQ(heeld(scene, {}).status, kExitConfiguration);
}

TEST(HeeldCheck, PrintsTheCommittedExampleAndManual) {
  const Scene scene(1);
  EXPECT_EQ(heeld(scene, {"--print-default-config"}).output, content_of(HEEL_SOURCE_DIR "/config/heel.toml"));
  EXPECT_EQ(heeld(scene, {"--print-config-manual"}).output,
            content_of(HEEL_SOURCE_DIR "/docs/configuration.md"));
}

}  // namespace
}  // namespace heel::test
