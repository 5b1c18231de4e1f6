// Which robots are driven, and with which numbers: the table of models, the choice by name, and a session
// that meets a robot it must not drive.
#include "robot/model_choice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "heel/error.h"
#include "models/robot_model_file.h"
#include "models/robot_models.h"
#include "robot/session_bench.h"
#include "robot/session_event_text.h"
#include "support/complaint.h"

namespace heel {
namespace {

using arcos::CommandId;
using test::bench_config;
using test::SessionBench;
using Kind = SessionEventKind;

// The numbers that the vendor's parameter files publish, typed in once more.
struct Published {
  const char* subclass;
  double dist, vel, range, diff, width_mm, length_mm;
  int sonars, sonars_ahead;
};
constexpr Published kPublished[] = {
    {"p3at-sh", 1.0, 1.0, 1.0, 0.0034, 505, 626, 16, 8},
    {"p3at", 0.465, 1.0, 1.0, 0.0034, 505, 626, 16, 8},
    {"p3dx-sh", 1.0, 1.0, 1.0, 0.0056, 425, 511, 16, 8},
    {"p3dx", 0.485, 1.0, 1.0, 0.0056, 425, 511, 16, 8},
    {"p2at8", 1.32, 1.0, 1.0, 0.0034, 505, 626, 16, 8},
    {"p2at", 1.32, 1.0, 0.268, 0.0034, 505, 626, 16, 8},
    {"amigo-sh", 1.0, 1.0, 1.0, 0.011, 279, 330, 8, 6},
    {"amigo", 0.5083, 0.6154, 1.0, 0.011, 279, 330, 8, 6},
    {"peoplebot-sh", 1.0, 1.0, 1.0, 0.0060, 425, 513, 32, 14},
    {"powerbot-sh", 1.0, 1.0, 1.0, 0.00373, 680, 911, 28, 14},
};

TEST(RobotModels, HaveThePublishedNumbers) {
  ASSERT_EQ(robot_models().size(), std::size(kPublished));
  EXPECT_EQ(robot_models()[0].subclass, "p3at-sh");
  for (const Published& published : kPublished) {
    SCOPED_TRACE(published.subclass);
    const RobotModel& model = robot_model(published.subclass);
    EXPECT_EQ(model.mm_per_position_unit, published.dist);
    EXPECT_EQ(model.mm_s_per_speed_unit, published.vel);
    EXPECT_EQ(model.mm_per_range_unit, published.range);
    EXPECT_NEAR(model.effective_track_m, 2e-3 / published.diff, 1e-3);
    EXPECT_EQ(model.heading_units_per_turn, 4096);
    EXPECT_NEAR(model.width_m, published.width_mm * 1e-3, 1e-9);
    EXPECT_NEAR(model.length_m, published.length_mm * 1e-3, 1e-9);
    EXPECT_EQ(__builtin_popcount(model.geometry.fitted), published.sonars);
    EXPECT_EQ(__builtin_popcount(model.geometry.ahead), published.sonars_ahead);
  }
}

TEST(RobotModels, SonarsAreInsideTheOutlineAndSymmetric) {
  for (const RobotModel& model : robot_models()) {
    const RobotGeometry& robot = model.geometry;
    for (std::size_t i = 0; i < kMaxSonars; ++i) {
      if (!robot.has_sonar(i)) continue;
      const Pose2& sonar = robot.sonars[i];
      EXPECT_LE(sonar.x_m, robot.front_m) << model.subclass << i;
      EXPECT_GE(sonar.x_m, -robot.rear_m) << model.subclass << i;
      EXPECT_LT(std::abs(sonar.y_m), robot.half_width_m) << model.subclass << i;
      int mirrored = 0;  // the amigo-sh's file has 125 mm on the left and 120 mm on the right
      for (std::size_t k = 0; k < kMaxSonars; ++k)
        mirrored += robot.has_sonar(k) && std::abs(robot.sonars[k].x_m - sonar.x_m) < 0.006 &&
                    std::abs(robot.sonars[k].y_m + sonar.y_m) < 1e-9 &&
                    std::abs(robot.sonars[k].heading_rad + sonar.heading_rad) < 1e-9;
      EXPECT_EQ(mirrored, 1) << model.subclass << i;
    }
  }
}

// To the bit: recordings of this robot are compared with earlier ones.
TEST(RobotModels, TheP3AtShIsWhatItAlwaysWas) {
  const RobotModel& model = robot_models()[0];
  EXPECT_EQ(model.effective_track_m, 0.588);
  EXPECT_EQ(model.geometry.front_m, 0.313);
  EXPECT_EQ(model.geometry.rear_m, 0.313);
  EXPECT_EQ(model.geometry.half_width_m, 0.25);
  EXPECT_EQ(model.geometry.ahead, 0x00FFu);
  EXPECT_EQ(model.geometry.sonars[2].x_m, 0.227);
  EXPECT_EQ(model.geometry.sonars[13].y_m, 0.079);
}

std::string file_with(const std::string& from, const std::string& to) {
  std::string text = R"(subclass = "own"
[units]
dist_conv = 1.0
vel_conv = 1.0
range_conv = 1.0
heading_units_per_turn = 4096
diff_conv = 0.0034
effective_track_mm = 588
[limits]
v_max_mm_s = 1000
yaw_rate_max_deg_s = 300
[outline]
width_mm = 500
length_mm = 600
front_mm = 300
rear_mm = 300
radius_mm = 400
half_width_mm = 250
[sonar]
places = [[0, 100, 100, 90], [1, 100, -100, -90], [2, -100, 0, 180]]
)";
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos);
  return text.replace(at, from.size(), to);
}

TEST(RobotModelFile, IsReadOrRefusedWithThePlace) {
  const RobotModel own = parse_robot_model(file_with("1.0", "0.5"), "own.toml");
  EXPECT_EQ(own.mm_per_position_unit, 0.5);
  EXPECT_EQ(own.geometry.fitted, 0b111u);
  EXPECT_EQ(own.geometry.ahead, 0b011u);
  const auto complaint = [](const std::string& from, const std::string& to) {
    return test::complaint_of([&] { parse_robot_model(file_with(from, to), "own.toml"); });
  };
  using testing::HasSubstr;
  EXPECT_THAT(complaint("subclass", "name"), HasSubstr("subclass"));
  EXPECT_THAT(complaint("588", "500"), HasSubstr("effective_track_mm: 500 (expected 2 / diff_conv, 588.2)"));
  EXPECT_THAT(complaint("[2,", "[1,"), HasSubstr("sonar 1 twice"));
  EXPECT_THAT(complaint("[2,", "[32,"), HasSubstr("sonar 32 (expected a whole number 0…31)"));
  EXPECT_THAT(complaint("-100, 0, 180", "-100, 0"), HasSubstr("a list of lists of 4 numbers"));
  EXPECT_THAT(complaint("rear_mm = 300", "rear_mm = 200"), HasSubstr("expected at least length_mm"));
  EXPECT_THAT(complaint("width_mm = 500", "width_mm = 400"), HasSubstr("half_width_mm"));
  EXPECT_THAT(complaint("vel_conv", "velconv"), HasSubstr("vel_conv"));
}

arcos::RobotIdentity identity(const char* robot_class, const char* subclass) {
  return {arcos::Text("rex"), arcos::Text(robot_class), arcos::Text(subclass)};
}

TEST(ModelChoice, TakesWhatTheRobotSays) {
  for (std::size_t i = 0; i < robot_models().size(); ++i) {
    const RobotKind kind = choose_model(identity("Pioneer", robot_models()[i].subclass.c_str()), "auto");
    EXPECT_EQ(kind.choice, ModelChoice::Chosen);
    EXPECT_EQ(kind.model, i);
    EXPECT_EQ(
        choose_model(identity("PIONEER", robot_models()[i].subclass.c_str()), robot_models()[i].subclass)
            .model,
        i);
  }
  EXPECT_EQ(choose_model(identity("Pioneer", "P3AT-SH"), "auto").choice, ModelChoice::Chosen);
}

TEST(ModelChoice, RefusesWhatItDoesNotKnow) {
  for (const auto& [robot_class, subclass] : {std::pair{"Roomba", "create"},
                                              {"Roomba", "p3at-sh"},
                                              {"Pioneer", "pion1m"},
                                              {"Pioneer", "p3at-s"},
                                              {"Pioneer", "p3at-sh "},
                                              {"Pioneer", ""},
                                              {"", "p3at-sh"},
                                              {"Pioneers", "p3at"},
                                              {"Roomba", ""}}) {
    EXPECT_EQ(choose_model(identity(robot_class, subclass), "auto").choice, ModelChoice::Unknown) << subclass;
    EXPECT_EQ(choose_model(identity(robot_class, subclass), "p3at-sh").choice, ModelChoice::Unknown)
        << subclass;
  }
}

TEST(ModelChoice, RefusesAnotherOneThanTheConfigured) {
  const RobotKind kind = choose_model(identity("Pioneer", "p3at"), "p3at-sh");
  EXPECT_EQ(kind.choice, ModelChoice::Conflict);
  EXPECT_EQ(robot_models()[kind.model].subclass, "p3at-sh");
}

TEST(ModelChoice, ARobotWithoutANameIsWhatTheConfigurationSays) {
  EXPECT_EQ(choose_model({}, "auto").choice, ModelChoice::Nameless);
  const RobotKind kind = choose_model({}, "p3dx");
  EXPECT_EQ(kind.choice, ModelChoice::Chosen);
  EXPECT_EQ(robot_models()[kind.model].subclass, "p3dx");
}

TEST(ModelChoice, NamesAreCutAndMadePrintable) {
  const RobotKind kind =
      choose_model(identity("A{}\x01\xC3", "a-name-that-is-longer-than-the-room-for-it"), "auto");
  EXPECT_STREQ(kind.robot_class.data(), "A????");
  EXPECT_STREQ(kind.subclass.data(), "a-name-that-is-longer-t");
}

std::string text_of(Kind event, const RobotKind& kind, std::size_t size = 192) {
  std::string out(size, 'x');
  write_event_text({.kind = event}, kind, "$GPGGA,1", out);
  return out.c_str();
}

TEST(SessionEventText, NamesTheRobot) {
  EXPECT_EQ(text_of(Kind::Synchronised, choose_model(identity("Pioneer", "p2at"), "auto")),
            "robot synchronised: class Pioneer, subclass p2at; driven as p2at");
  EXPECT_EQ(
      text_of(Kind::ModelConflict, choose_model(identity("Pioneer", "p3at"), "peoplebot-sh")),
      "robot is not driven: it is a p3at, and robot.model is peoplebot-sh; set robot.model = \"auto\", or "
      "connect the peoplebot-sh");
  const RobotKind longest =
      choose_model(identity("ClassOfTwentyThreeChars", "SubclassOfTwentyThreeCh"), "auto");
  EXPECT_THAT(text_of(Kind::ModelUnknown, longest), testing::EndsWith("lists the robots that it knows"));
  EXPECT_THAT(text_of(Kind::RateRaised, longest), testing::HasSubstr("{} baud"));
  EXPECT_EQ(text_of(Kind::ModelUnknown, longest, 10), "robot is ");
}

TEST(SessionEventText, QuotesANameThatIsNone) {
  EXPECT_THAT(text_of(Kind::ModelUnknown, choose_model(identity("Pioneer", ""), "auto")),
              testing::HasSubstr("class Pioneer, subclass '', which"));
  EXPECT_THAT(text_of(Kind::ModelUnknown, choose_model(identity("", "my robot, and"), "auto")),
              testing::HasSubstr("class '', subclass 'my robot, and', which"));
}

/// Nothing but the handshake and CLOSE was sent.
void expect_never_driven(const SessionBench& bench) {
  for (const test::Received& one : bench.robot.log) {
    const bool harmless = one.is(CommandId::Sync0) || one.is(CommandId::Sync1) || one.is(CommandId::Sync2) ||
                          one.is(CommandId::Close);
    EXPECT_TRUE(harmless) << one.id;
    EXPECT_FALSE(one.is(CommandId::Open, 1));
  }
  EXPECT_FALSE(bench.robot.open);
}

TEST(ArcosSessionModel, ARobotThatIsNotKnownIsNeverOpened) {
  SessionBench bench;
  bench.robot.identity = identity("Roomba", "create");
  bench.v_m_s = 0.5;
  ASSERT_TRUE(bench.run_until(LinkPhase::Refused));
  for (int i = 0; i < 3000; ++i) {
    bench.tick();
    ASSERT_EQ(bench.session.state().phase, LinkPhase::Refused) << "also while it is asked again";
  }
  expect_never_driven(bench);
  EXPECT_EQ(bench.count(Kind::ModelUnknown), 1) << "one line, not one for each attempt";
  EXPECT_STREQ(bench.session.state().kind.subclass.data(), "create");
  const std::span<const std::uint8_t> farewell = bench.session.close(bench.now_ns);
  EXPECT_THAT(std::vector(farewell.begin(), farewell.end()),
              testing::ElementsAreArray(arcos::encode_plain(arcos::CommandId::Close).bytes()))
      << "and nothing else, also at the end";
}

TEST(ArcosSessionModel, AConflictAndAMissingNameAreRefused) {
  RobotConfig config = bench_config();
  config.model = "p3dx-sh";
  SessionBench conflict(config);
  ASSERT_TRUE(conflict.run_until(LinkPhase::Refused));
  EXPECT_EQ(conflict.count(Kind::ModelConflict), 1);
  expect_never_driven(conflict);

  SessionBench nameless;
  nameless.robot.names_damaged = true;
  ASSERT_TRUE(nameless.run_until(LinkPhase::Refused));
  EXPECT_EQ(nameless.count(Kind::ModelMissing), 1);
  expect_never_driven(nameless);

  SessionBench named(config);
  named.robot.names_damaged = true;
  EXPECT_TRUE(named.run_until(LinkPhase::Running));
  EXPECT_EQ(robot_models()[named.session.state().kind.model].subclass, "p3dx-sh");
}

TEST(ArcosSessionModel, AnotherRobotOnTheSameLineIsDriven) {
  SessionBench bench;
  bench.robot.identity = identity("Pioneer", "pion1m");
  ASSERT_TRUE(bench.run_until(LinkPhase::Refused));
  bench.robot.identity = identity("Pioneer", "p3at");
  EXPECT_TRUE(bench.run_until(LinkPhase::Running, 15.0));
}

TEST(ArcosSessionModel, UnitsAreThoseOfTheRobot) {
  SessionBench bench;
  bench.robot.identity = identity("Pioneer", "p2at");
  ASSERT_TRUE(bench.run_until(LinkPhase::Running));
  bench.robot.sip.sonar_count = 2;
  bench.robot.sip.sonars[0] = {4, 10000};
  bench.robot.sip.sonars[1] = {16, 1000};  // it has no such sonar
  bench.robot.sip.x_pos = 100;
  bench.run(0.3);
  EXPECT_NEAR(bench.session.state().sonar[4].range_m, 2.68, 1e-9);
  EXPECT_EQ(bench.session.state().sonar[16].t_ns, 0);
  EXPECT_NEAR(bench.session.state().odometry.x_m, 0.132, 1e-9);

  SessionBench slow;
  slow.robot.identity = identity("Pioneer", "amigo");
  ASSERT_TRUE(slow.run_until(LinkPhase::Running));
  slow.v_m_s = 0.5;
  slow.robot.sip.left_mm_s = slow.robot.sip.right_mm_s = 500;
  slow.run(0.5);
  EXPECT_NEAR(slow.session.state().odometry.v_m_s, 0.3077, 1e-9);
  EXPECT_EQ(slow.robot.received(CommandId::Vel).back().value, 500) << "commands are in mm/s";
}

TEST(ArcosSessionModel, AModelsLimitsBind) {
  RobotConfig config = bench_config();
  config.v_limit_mm_s = 1200;
  SessionBench bench(config);
  bench.robot.identity = identity("Pioneer", "amigo-sh");
  ASSERT_TRUE(bench.run_until(LinkPhase::Running));
  EXPECT_EQ(bench.robot.received(CommandId::SetV).back().value, 1000);
  bench.v_m_s = 1.2;
  bench.run(0.5);
  EXPECT_EQ(bench.robot.received(CommandId::Vel).back().value, 1000);
}

}  // namespace
}  // namespace heel
