// The parser with hand-written files: what is accepted, what is refused, and the messages.
#include "config/config_load.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <set>
#include <sstream>
#include <type_traits>
#include <variant>

#include "config/config_table.h"
#include "config/config_text.h"
#include "config/config_value.h"
#include "models/robot_models.h"
#include "support/complaint.h"
#include "support/temporary_folder.h"

namespace heel {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<std::string> complaints_about(const std::string& text) {
  try {
    parse_config(text, "f.toml");
  } catch (const ConfigError& error) {
    return error.lines();
  }
  return {};
}

TEST(ConfigLoad, ReadsValuesAndTheirLines) {
  const LoadedConfig loaded = parse_config("[control]\n\ngain_yaw_1_s = 3\nreverse = true\n", "/etc/f.toml");
  EXPECT_EQ(loaded.config.control.gain_yaw_1_s, 3.0);
  EXPECT_TRUE(loaded.config.control.reverse);
  EXPECT_EQ(loaded.config.control.rate_hz, Config().control.rate_hz);
  EXPECT_THAT(config_listing(loaded), HasSubstr("/etc/f.toml:3\n"));
  int from_file = 0;
  for (const int line : loaded.line_of) from_file += line != 0;
  EXPECT_EQ(from_file, 2);
}

TEST(ConfigLoad, UnknownKeyNamesPlaceAndNearest) {
  EXPECT_THAT(
      complaints_about("[control]\n  gain_yaw_1s = 3\n"),
      ElementsAre("f.toml:2:3: control.gain_yaw_1s: no such key; did you mean control.gain_yaw_1_s?"));
}

TEST(ConfigLoad, RemovedKeySaysWhyAndWhatToDo) {
  EXPECT_THAT(complaints_about("[vision]\nransac_budget_ms = 10.0\n"),
              ElementsAre("f.toml:2:1: vision.ransac_budget_ms: removed: vision.ransac_iterations alone "
                          "limits RANSAC; delete this line"));
}

TEST(ConfigLoad, UnknownSectionNamesPlaceAndNearest) {
  EXPECT_THAT(complaints_about("[contorl]\nrate_hz = 50\n"),
              ElementsAre("f.toml:1:2: contorl: no such section; did you mean control?"));
}

TEST(ConfigLoad, ReportsAllErrorsAtOnce) {
  EXPECT_THAT(
      complaints_about("[gate]\nv_max_m_s = 'fast'\nacceleration_m_s2 = -1\n[camera]\nwidth_px = 640.5\n"
                       "at_end = \"pause\"\nsource = \"usb\"\n[robot]\nsonar = 1\n"),
      ElementsAre(
          "f.toml:2:13: gate.v_max_m_s: 'fast' (expected a number 0…1.2 m/s)",
          "f.toml:3:21: gate.acceleration_m_s2: -1 (expected a number 0.05…5 m/s²)",
          "f.toml:5:12: camera.width_px: 640.5 (expected a whole number 64…4096 px)",
          "f.toml:6:10: camera.at_end: 'pause' (expected stop or loop)",
          "f.toml:7:10: camera.source: 'usb' (expected v4l2:…, libcamera:…, file:… or sim:…, in quotes)",
          "f.toml:9:9: robot.sonar: 1 (expected true or false)"));
}

TEST(ConfigLoad, RefusesNotANumberAndInfinity) {
  EXPECT_EQ(complaints_about("[gate]\nv_max_m_s = nan\nacceleration_m_s2 = inf\n").size(), 2u);
}

TEST(ConfigLoad, RefusesIntegersThatOverflow) {
  EXPECT_EQ(complaints_about("[camera]\nwidth_px = 4294967936\n").size(), 1u);
}

TEST(ConfigLoad, NamesTheOnlyValuesOfAKey) {
  EXPECT_THAT(
      complaints_about("[camera]\nrotate = 360\n"),
      ElementsAre("f.toml:2:10: camera.rotate: 360 (expected a whole number 0…270 deg; it must be 0, 90, "
                  "180 or 270)"));
  EXPECT_THAT(complaints_about("[camera]\nrotate = 45\n"),
              ElementsAre(HasSubstr("(must be 0, 90, 180 or 270)")));
}

TEST(ConfigLoad, RefusesListsAndTablesAsValues) {
  EXPECT_THAT(complaints_about("[gate]\nv_max_m_s = [1]\n"),
              ElementsAre(HasSubstr("gate.v_max_m_s: a list (expected a number")));
  EXPECT_THAT(complaints_about("[gate.v_max_m_s]\nx = 1\n"),
              ElementsAre(HasSubstr("gate.v_max_m_s: a section (expected a number")));
  EXPECT_THAT(complaints_about("gate = 3\n"), ElementsAre(HasSubstr("is a section (expected [gate])")));
}

TEST(ConfigLoad, SyntaxErrorsNameThePlace) {
  EXPECT_THAT(complaints_about("[gate]\nv_max_m_s = = 3\n"), ElementsAre(HasSubstr("f.toml:2:13: ")));
}

TEST(ConfigLoad, ChecksKeysAgainstEachOther) {
  EXPECT_THAT(complaints_about("[supervisor]\ncertainty_drop = 0.5\n"),
              ElementsAre("f.toml:2:1: supervisor.certainty_drop: 0.5 (must not be larger than "
                          "supervisor.certainty_follow)"));
  // The wrong key has its default: there is no line to name.
  std::ostringstream standing;
  standing << SupervisorConfig{}.certainty_drop;
  EXPECT_THAT(complaints_about("[supervisor]\ncertainty_follow = 0.01\n"),
              ElementsAre("f.toml: supervisor.certainty_drop: " + standing.str() +
                          " (must not be larger than supervisor.certainty_follow)"));
}

TEST(ConfigLoad, DefaultsPassTheirOwnChecks) {
  EXPECT_TRUE(complaints_about("").empty());
  EXPECT_TRUE(complaints_about(default_config_text()).empty());
}

TEST(ConfigLoad, RelativePathsAreRelativeToTheFile) {
  const Config config =
      parse_config(
          "[target]\nshirt = \"red.heel\"\n[camera]\nsource = \"file:../v.mp4\"\ninfo = \"/a/c.yaml\"\n"
          "[robot]\naddress = \"tcp:localhost:8101\"\n",
          "/etc/heel/f.toml")
          .config;
  EXPECT_EQ(config.target.shirt, "/etc/heel/red.heel");
  EXPECT_EQ(config.camera.source, "file:/etc/v.mp4");
  EXPECT_EQ(config.camera.info, "/a/c.yaml");
  EXPECT_EQ(config.robot.address, "tcp:localhost:8101");
  EXPECT_EQ(config.telemetry.directory, "");
}

TEST(ConfigLoad, AListOfPathsIsRelativeToTheFile) {
  const Config config =
      parse_config("[target]\nmore_shirts = [\"side.heel\", \"/a/front.heel\"]\n", "/etc/heel/f.toml").config;
  EXPECT_THAT(config.target.more_shirts, ElementsAre("/etc/heel/side.heel", "/a/front.heel"));
}

TEST(ConfigLoad, AListOfPathsHoldsTextAndNotTooMuchOfIt) {
  for (const char* wrong :
       {"\"side.heel\"", "[1]", "[\"\"]", "[\"a\",\"a\",\"a\",\"a\",\"a\",\"a\",\"a\",\"a\"]"}) {
    EXPECT_THAT(complaints_about(std::string("[target]\nmore_shirts = ") + wrong + "\n"),
                ElementsAre(HasSubstr("(expected at most 7 paths in quotes")))
        << wrong;
  }
}

TEST(ConfigLoad, ThePageListensAtAnAddressInNumbersAndItsNamesAreThoseOfHosts) {
  for (const char* good : {"", "127.0.0.1:8080", "0.0.0.0:0", "[::1]:65535"})
    EXPECT_EQ(
        parse_config(std::string("[view]\naddress = \"") + good + "\"\n", "/etc/f.toml").config.view.address,
        good);
  for (const char* bad :
       {"8080", "localhost:8080", "127.0.0.1:", "127.0.0.1:65536", "::1:80", "1.2.3:80", "a:80 "})
    EXPECT_THAT(complaints_about(std::string("[view]\naddress = \"") + bad + "\"\n"),
                ElementsAre(HasSubstr("(expected IP:PORT in quotes")))
        << bad;
  const Config config = parse_config("[view]\nhosts = [\"robot.local\"]\n", "/etc/f.toml").config;
  EXPECT_THAT(config.view.hosts, ElementsAre("robot.local")) << "a name is no path";
  EXPECT_THAT(complaints_about("[view]\nhosts = [\"http://robot\"]\n"),
              ElementsAre(HasSubstr("(expected at most 16 names of hosts in quotes")));
}

TEST(ConfigLoad, TheBrokerIsATcpOrTlsAddressAndItsTopicAndUserAreALine) {
  const Config config = parse_config(
                            "[mqtt]\naddress = \"ssl://broker.example:8883\"\ntopic = \"site/robot 1\"\n"
                            "user = \"anna@site\"\npassword_file = \"pw\"\nca_file = \"ca.pem\"\n",
                            "/etc/heel/heel.toml")
                            .config;
  EXPECT_EQ(config.mqtt.address, "ssl://broker.example:8883");
  EXPECT_EQ(config.mqtt.password_file, "/etc/heel/pw");
  EXPECT_EQ(config.mqtt.ca_file, "/etc/heel/ca.pem");
  const auto about = [](const std::string& key, const std::string& value) {
    return complaints_about("[mqtt]\n" + key + " = " + value + "\n");
  };
  const auto quoted = [](const char* text) { return std::string("\"") + text + "\""; };
  for (const char* good : {"", "tcp://10.0.0.7:1883", "tcp://[::1]:1883"})
    EXPECT_THAT(about("address", quoted(good)), ElementsAre()) << good;
  for (const char* bad : {"broker:1883", "tcp://broker", "tcp://broker:0", "tcp://:1883", "tcp://a b:1",
                          "tcp://broker:99999", "mqtt://broker:1883", "ssl://[::1:8883", "tcp://a/b:1"})
    EXPECT_THAT(about("address", quoted(bad)), ElementsAre(HasSubstr("f.toml:2:11: mqtt.address: "))) << bad;
  for (const char* bad : {"", "a/#", "+/b", "/a", "a/", "a//b", "$SYS/a", "a\\u0001"})
    EXPECT_THAT(about("topic", quoted(bad)), ElementsAre(HasSubstr("f.toml:2:9: mqtt.topic: "))) << bad;
  EXPECT_THAT(about("user", quoted("a\\nb")), ElementsAre(HasSubstr("f.toml:2:8: mqtt.user: ")));
  EXPECT_THAT(about("period_s", "0"), ElementsAre(HasSubstr("2:12: mqtt.period_s: 0 (expected a number")));
}

TEST(ConfigLoad, APasswordNeedsAUserAndAnAuthorityNeedsTls) {
  EXPECT_THAT(complaints_about("[mqtt]\npassword_file = \"pw\"\n"),
              ElementsAre(HasSubstr("f.toml:2:1: mqtt.password_file: \"pw\" (is the password of mqtt.user")));
  EXPECT_THAT(complaints_about("[mqtt]\naddress = \"tcp://a:1\"\nca_file = \"ca\"\n"),
              ElementsAre(HasSubstr("f.toml:3:1: mqtt.ca_file: \"ca\" (is for an mqtt.address")));
}

TEST(ConfigLoad, PathsInAddressesAreRelativeToTheFile) {
  for (const char* scheme : {"serial", "pty"}) {
    const std::string text = std::string("[robot]\naddress = \"") + scheme + ":dev/robot\"\n";
    EXPECT_EQ(parse_config(text, "/etc/heel/f.toml").config.robot.address,
              std::string(scheme) + ":/etc/heel/dev/robot");
  }
  for (const char* scheme : {"file", "v4l2"}) {
    const std::string text = std::string("[camera]\nsource = \"") + scheme + ":dev/camera\"\n";
    EXPECT_EQ(parse_config(text, "/etc/heel/f.toml").config.camera.source,
              std::string(scheme) + ":/etc/heel/dev/camera");
  }
  for (const char* address : {"libcamera:dev/camera", "sim:camera"}) {
    const std::string text = std::string("[camera]\nsource = \"") + address + "\"\n";
    EXPECT_EQ(parse_config(text, "/etc/heel/f.toml").config.camera.source, address) << "it holds no path";
  }
}

TEST(ConfigLoad, AnEmptyFileMeansAllDefaults) {
  for (const char* text : {"", "\n", "# nothing\n", "\xEF\xBB\xBF\r\n"}) {
    const LoadedConfig loaded = parse_config(text, "f.toml");
    EXPECT_EQ(loaded.config.camera.rate_hz, Config().camera.rate_hz);
    EXPECT_EQ(loaded.config.control.law, Config().control.law);
    for (const int line : loaded.line_of) EXPECT_EQ(line, 0);
  }
  const test::TemporaryFolder folder;
  EXPECT_EQ(load_config(test::write_text(folder.file("empty.toml"), "")).config.control.law,
            Config().control.law);
}

TEST(ConfigLoad, MissingFileIsNamed) {
  EXPECT_THAT(
      test::complaint_of([] { load_config("/nowhere/heel.toml"); }),
      HasSubstr("/nowhere/heel.toml: cannot read: No such file or directory (expected a configuration file"));
}

TEST(ConfigLoad, NamesKeysThatNeedARestart) {
  Config before, after;
  after.control.gain_yaw_1_s = 5;
  EXPECT_TRUE(keys_needing_restart(before, after).empty());
  after.camera.width_px = 320;
  after.control.law = "position";
  after.robot.sonar = !before.robot.sonar;
  EXPECT_THAT(keys_needing_restart(before, after),
              ElementsAre("camera.width_px", "control.law", "robot.sonar"));
}

/// The default of a key that is a number.
std::optional<double> default_number(const ConfigKey& key, Config& config) {
  return std::visit(
      [&](auto field) -> std::optional<double> {
        using Value = std::remove_cvref_t<decltype(*field(config))>;
        if constexpr (std::is_arithmetic_v<Value> && !std::is_same_v<Value, bool>)
          return static_cast<double>(*field(config));
        else
          return std::nullopt;
      },
      key.field);
}

TEST(ConfigTable, EveryKeyIsDescribedOnceInAKnownSectionWithADefaultInRange) {
  std::set<std::string> names;
  std::set<const void*> members;
  Config config;
  ASSERT_GT(config_keys().size(), 50u);
  for (const auto& key : config_keys()) {
    if (const std::optional<double> number = default_number(key, config)) {
      EXPECT_GE(*number, key.min) << key.full_name();
      EXPECT_LE(*number, key.max) << key.full_name();
    }
    EXPECT_TRUE(names.insert(key.full_name()).second) << key.full_name();
    EXPECT_TRUE(
        members.insert(std::visit([&](auto field) -> const void* { return field(config); }, key.field))
            .second)
        << key.full_name();
    EXPECT_TRUE(key.effect.ends_with('.')) << key.full_name();
    bool section_known = false;
    for (const auto& section : config_sections()) section_known |= section.name == key.section;
    EXPECT_TRUE(section_known) << key.full_name();
  }
}

TEST(ConfigTable, RobotModelOffersWhatHeelKnows) {
  std::string expected = "auto";
  for (const RobotModel& model : robot_models()) expected += "|" + model.subclass;
  EXPECT_EQ(config_keys()[index_of_key("robot.model").value()].choices, expected);
}

TEST(ConfigTable, RemovedKeysAreNotInTheTable) {
  for (const auto& removed : removed_config_keys())
    for (const auto& key : config_keys()) EXPECT_NE(key.full_name(), removed.full_name);
}

TEST(ConfigTable, EveryNumberJustOutsideItsRangeIsRefused) {
  int numbers = 0;
  for (const auto& key : config_keys()) {
    if (type_name(key) != "int" && type_name(key) != "real") continue;
    const bool whole = type_name(key) == "int";
    ++numbers;
    for (const double value : {key.min - 1.0, key.max + 1.0}) {
      const std::string text = whole ? std::to_string(static_cast<long>(value)) : std::to_string(value);
      EXPECT_EQ(
          complaints_about("[" + std::string(key.section) + "]\n" + std::string(key.name) + " = " + text)
              .size(),
          1u)
          << key.full_name() << " " << text;
    }
  }
  EXPECT_GT(numbers, 30);
}

}  // namespace
}  // namespace heel
