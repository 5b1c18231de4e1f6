// heeld's command line without a robot: --check, --print-…, and the messages for bad input.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "files/camera_info.h"
#include "files/template_file.h"
#include "heel/shirt_template.h"
#include "loopback/daemon/scene.h"
#include "support/process.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace heel {
namespace {

using test::Outcome;
using test::read_text;
using test::run_program;
using test::Scene;
using test::source_path;
using test::write_text;

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

Outcome heeld(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), test::built_program("heeld"));
  return run_program(arguments);
}

/// "FILE:LINE" of the line of `file` that starts with `begin`.
std::string place_of(const std::string& file, const std::string& begin) {
  const std::string text = read_text(file);
  const std::size_t at = text.find("\n" + begin);
  EXPECT_NE(at, std::string::npos) << begin;
  const auto lines_before = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
  return file + ":" + std::to_string(lines_before + 2);
}

constexpr int kExitUsage = 64;
constexpr int kExitConfiguration = 78;

TEST(HeeldCheck, AGoodConfigurationIsListedWithOriginsAndVerdict) {
  const Scene scene(1);
  const std::string config = scene.write_config({.sections = "[gate]\nv_max_m_s = 0.5\n"});
  const Outcome outcome = heeld({"--config", config, "--check"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("gate.v_max_m_s"), HasSubstr(place_of(config, "v_max_m_s") + "\n"),
                                 HasSubstr("# default\n"), HasSubstr("taken at 2.00 m")));
}

TEST(HeeldCheck, ACameraFileOfSqueezedPicturesIsWarnedOf) {
  const Scene scene(1);
  const std::string config = scene.write_config({});
  const auto usual = nlohmann::json::parse(heeld({"--config", config, "--check", "--json"}).out);
  EXPECT_EQ(usual["warnings"], nlohmann::json::array());
  const std::string file = usual["camera"]["file"];
  CameraModel squeezed = read_camera_model(file);
  squeezed.fy /= 1.5;
  write_camera_model(squeezed, file);
  const Outcome said = heeld({"--config", config, "--check"});
  EXPECT_EQ(said.status, 0) << said.err;
  const std::string warning = file + ": camera_matrix.data: fy ";
  EXPECT_THAT(said.out, AllOf(HasSubstr("warning: " + warning), HasSubstr("squeezed to")));
  const auto json = nlohmann::json::parse(heeld({"--config", config, "--check", "--json"}).out);
  EXPECT_TRUE(json["valid"]);
  EXPECT_THAT(json["warnings"][0].get<std::string>(), HasSubstr(warning));
}

TEST(HeeldCheck, WhoCanReachThePageIsSaid) {
  const Scene scene(1);
  const auto said = [&](const std::string& view) {
    const Outcome outcome =
        heeld({"--config", scene.write_config({.sections = "[view]\n" + view}), "--check"});
    return outcome.out.substr(outcome.out.rfind("view.address: ") + 1) + outcome.err;
  };
  EXPECT_THAT(heeld({"--config", scene.write_config(), "--check"}).out, Not(HasSubstr("the page")));
  EXPECT_THAT(said("address = \"127.0.0.1:8080\"\n"),
              AllOf(HasSubstr("for this computer alone"), HasSubstr("there is no token (view.token_file)")));
  EXPECT_THAT(said("address = \"0.0.0.0:8080\"\n"),
              AllOf(HasSubstr("open to the network"), HasSubstr("there is no token (view.token_file)")));
  std::filesystem::permissions(write_text(scene.path("token"), "0123456789abcdef"),
                               std::filesystem::perms::owner_read);
  EXPECT_THAT(said("address = \"0.0.0.0:8080\"\ntoken_file = \"token\"\n"),
              AllOf(HasSubstr("open to the network"), HasSubstr("who knows the token can")));
  EXPECT_THAT(said("address = \"0.0.0.0:8080\"\ntoken_file = \"none\"\n"),
              HasSubstr("none: cannot be read: No such file or directory"));
}

TEST(HeeldCheck, WhereTheStatusGoesByMqttIsSaid) {
  const Scene scene(1);
  const auto check = [&](const std::string& mqtt) {
    return heeld({"--config", scene.write_config({.sections = "[mqtt]\n" + mqtt}), "--check"});
  };
  EXPECT_THAT(check("").out, Not(HasSubstr("the status goes to")));
  EXPECT_THAT(check("address = \"tcp://broker:1883\"\n").out, HasSubstr("without encryption"));
  const Outcome outcome = check("address = \"ssl://broker:8883\"\nuser = \"a\"\npassword_file = \"none\"\n");
  EXPECT_EQ(outcome.status, kExitConfiguration);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("mqtt.password_file: "), HasSubstr("none: cannot be read")));
}

TEST(HeeldCheck, AllErrorsOfAFileAreReported) {
  const Scene scene(1);
  const std::string config = scene.write_config({.sections = "[gate]\nv_max = 0.5\nseparation_m = -1\n"});
  const Outcome outcome = heeld({"--config", config, "--check"});
  EXPECT_EQ(outcome.status, kExitConfiguration);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err,
            place_of(config, "v_max") + ":1: gate.v_max: no such key; did you mean gate.v_max_m_s?\n" +
                place_of(config, "separation_m") + ":16: gate.separation_m: -1 (expected a number 0…5 m)\n");
}

TEST(HeeldCheck, JsonHasTheValuesOrTheErrorsOfAFile) {
  const Scene scene(1);
  const auto check = [&](const std::string& sections) {
    const Outcome outcome =
        heeld({"--config", scene.write_config({.sections = sections}), "--check", "--json"});
    EXPECT_EQ(outcome.err, "");
    auto json = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(outcome.status, json.at("valid").get<bool>() ? 0 : kExitConfiguration);
    return json;
  };
  const auto good = check("[gate]\nv_max_m_s = 0.5\n");
  EXPECT_TRUE(good.at("valid"));
  EXPECT_TRUE(good.at("errors").empty());
  EXPECT_EQ(good.at("camera").at("width_px"), 640);
  int set = 0, by_default = 0;
  for (const auto& key : good.at("keys")) {
    if (key.at("key") == "gate.v_max_m_s") {
      EXPECT_EQ(key.at("value"), 0.5);
      EXPECT_GT(key.at("line"), 0);
      ++set;
    }
    by_default += key.at("line") == 0;
  }
  EXPECT_EQ(set, 1);
  EXPECT_GT(by_default, 50);

  const auto bad = check("[gate]\nv_max = 0.5\nseparation_m = -1\n");
  EXPECT_FALSE(bad.at("valid"));
  EXPECT_EQ(bad.at("errors").size(), 2U);
  EXPECT_THAT(bad.at("errors")[0].get<std::string>(), HasSubstr("did you mean gate.v_max_m_s?"));
  EXPECT_FALSE(bad.contains("keys"));
  EXPECT_EQ(heeld({"--config", scene.write_config(), "--json"}).status, kExitUsage) << "without --check";
}

TEST(HeeldCheck, ATemplateThatDoesNotSayWhetherItIsUprightIsNamed) {
  const Scene scene(1);
  EXPECT_THAT(heeld({"--config", scene.write_config({.camera = "rotate = 180\n"}), "--check"}).out,
              HasSubstr("it does not say whether it is upright"));
  EXPECT_THAT(heeld({"--config", scene.write_config(), "--check"}).out, Not(HasSubstr("upright")));
}

TEST(HeeldCheck, WhatIsWrongStandsBehindTheValues) {
  const Scene scene(1);
  std::filesystem::remove(scene.path("shirt.heel"));
  const Outcome both = test::run_program(
      {"/bin/sh", "-c",
       "'" + test::built_program("heeld") + "' --check --config '" + scene.write_config() + "' 2>&1"});
  EXPECT_EQ(both.status, kExitConfiguration);
  const std::size_t values = both.out.find("gate.v_max_m_s"),
                    error = both.out.find(scene.path("shirt.heel") + ": ");
  ASSERT_NE(error, std::string::npos) << both.out;
  EXPECT_LT(values, error) << both.out;
}

TEST(HeeldCheck, FilesItRefersToAreLoaded) {
  const Scene scene(1);
  std::filesystem::remove(scene.path("shirt.heel"));
  const Outcome outcome = heeld({"--config", scene.write_config(), "--check"});
  EXPECT_EQ(outcome.status, kExitConfiguration);
  EXPECT_THAT(outcome.err, HasSubstr(scene.path("shirt.heel")));
}

TEST(HeeldCheck, ACameraWhoseModuleIsNotInstalledIsNamedWithTheFile) {
  const Scene scene(1);
  const std::string alone = scene.path("heeld");
  std::filesystem::copy_file(test::built_program("heeld"), alone);
  const Outcome outcome = run_program({alone, "--config", scene.write_config()});
  EXPECT_EQ(outcome.status, kExitConfiguration);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("camera address 'file:"), HasSubstr("camera-file.so"),
                                 HasSubstr("install the package again")));
}

TEST(HeeldCheck, ATemplateNeedsADistance) {
  const Scene scene(1);
  ShirtTemplate shirt = read_template(scene.path("shirt.heel"));
  shirt.distance_m = 0.0;
  write_template(shirt, scene.path("unknown.heel"));
  const std::string text = read_text(scene.write_config());
  const auto check = [&](const std::string& target) {
    std::string changed = text;
    const std::string key = "shirt = \"shirt.heel\"\n";
    changed.replace(changed.find(key), key.size(), target);
    return heeld({"--config", write_text(scene.path("unknown.toml"), changed), "--check"});
  };
  const Outcome without = check("shirt = \"unknown.heel\"\n");
  EXPECT_EQ(without.status, kExitConfiguration);
  EXPECT_THAT(without.err, HasSubstr("unknown.heel: has no distance (expected one, or target.distance_m)"));
  const Outcome with = check("shirt = \"unknown.heel\"\ndistance_m = 1.75\n");
  EXPECT_EQ(with.status, 0) << with.err;
  EXPECT_THAT(with.out, HasSubstr("taken at 1.75 m"));
}

TEST(HeeldCheck, CamerasOfPublicReportsThatCannotExistAreRefused) {
  HEEL_NEEDS_TEST_DATA("reports");
  const Scene scene(1);
  std::string config = read_text(scene.write_config());
  const std::size_t key = config.find("info = "), end = config.find('\n', key);
  ASSERT_NE(key, std::string::npos) << config;
  for (const char* name : {"10_edited_resolution", "11_negative_c", "20_fx_mm"}) {
    const std::string file = test::data_path(std::string("reports/camera-file-impossible/") + name + ".yaml");
    std::string changed = config;
    changed.replace(key, end - key, "info = \"" + file + "\"");
    const Outcome outcome = heeld({"--config", write_text(scene.path("changed.toml"), changed), "--check"});
    EXPECT_EQ(outcome.status, kExitConfiguration) << name;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr(file + ": camera_matrix.data: "), HasSubstr("(expected ")));
  }
}

TEST(HeeldCheck, BearingLimitMustFitTheCamera) {
  const Scene scene(1);
  const std::string config = scene.write_config({.sections = "[control]\nbearing_max_rad = 0.6\n"});
  const Outcome outcome = heeld({"--config", config, "--check"});
  EXPECT_EQ(outcome.status, kExitConfiguration);
  EXPECT_THAT(outcome.err, HasSubstr("control.bearing_max_rad: 0.6 (expected less than"));
}

TEST(HeeldCheck, AFileCameraMustRunInRealTime) {
  const Scene scene(1);
  const Outcome outcome = heeld({"--config", scene.write_config({.camera = "file_speed = 0\n"}), "--check"});
  EXPECT_EQ(outcome.status, kExitConfiguration);
  EXPECT_THAT(outcome.err, HasSubstr("camera.file_speed: 0 (expected more than 0"));
}

TEST(HeeldCheck, TheRobotsAddressIsUnderstood) {
  const Scene scene(1);
  std::string text = read_text(scene.write_config());
  const std::size_t at = text.find("address = \"");
  text.replace(at, text.find('\n', at) - at, "address = \"tcp:10.0.0.2\"");
  const Outcome outcome = heeld({"--config", write_text(scene.path("no_port.toml"), text), "--check"});
  EXPECT_EQ(outcome.status, kExitConfiguration);
  EXPECT_THAT(outcome.err, HasSubstr("robot address 'tcp:10.0.0.2': no port (expected tcp:HOST:PORT)"));
}

TEST(HeeldCheck, AMissingConfigurationIsNamed) {
  const Outcome outcome = heeld({"--config", "/nowhere.toml"});
  EXPECT_EQ(outcome.status, kExitConfiguration);
  EXPECT_THAT(outcome.err, HasSubstr("/nowhere.toml: cannot read"));
  EXPECT_EQ(heeld({}).status, kExitConfiguration);
}

TEST(HeeldCheck, ACommandLineThatCannotBeUsedIsRefusedInOneLine) {
  const struct {
    std::vector<std::string> arguments;
    std::string line;
  } rows[] = {
      {{"--confg", "heel.toml"}, "heeld: --confg: unknown option (see heeld --help)\n"},
      {{"heel.toml"}, "heeld: 'heel.toml': not an option (expected --config FILE) (see heeld --help)\n"},
      {{"--config"}, "heeld: --config: 1 required FILE missing (see heeld --help)\n"},
      {{"--check"}, "heeld: --check requires --config (see heeld --help)\n"},
      {{"--config", ""},
       "heeld: --config: an empty name (expected a file; is a variable of the shell not set?) (see heeld "
       "--help)\n"},
  };
  for (const auto& row : rows) {
    const Outcome outcome = heeld(row.arguments);
    EXPECT_EQ(outcome.status, kExitUsage) << row.line;
    EXPECT_EQ(outcome.out, "") << row.line;
    EXPECT_EQ(outcome.err, row.line);
  }
}

TEST(HeeldCheck, HelpStatesTheExitStatuses) {
  const Outcome help = heeld({"--help"});
  EXPECT_EQ(help.status, 0);
  EXPECT_EQ(help.err, "");
  EXPECT_THAT(help.out, AllOf(HasSubstr("--print-default-config"), HasSubstr("64 the command line")));
}

TEST(HeeldCheck, PrintsTheCommittedExampleAndManual) {
  const Outcome example = heeld({"--print-default-config"}), manual = heeld({"--print-config-manual"}),
                states = heeld({"--print-state-manual"}), threads = heeld({"--print-threads"});
  EXPECT_EQ(example.out, read_text(source_path("config/heel.toml")));
  EXPECT_EQ(manual.out, read_text(source_path("docs/configuration.md")));
  EXPECT_THAT(read_text(source_path("docs/safety.md")), HasSubstr(states.out));
  EXPECT_THAT(read_text(source_path("docs/real-time.md")), HasSubstr(threads.out));
  for (const Outcome& outcome : {example, manual, states, threads}) {
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.err, "");
    EXPECT_GT(outcome.out.size(), 1000u);
  }
}

}  // namespace
}  // namespace heel
