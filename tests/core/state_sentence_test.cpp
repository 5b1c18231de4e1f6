// The sentence for each state, and the names of all values of the flow enumerations.
#include "core/state_sentence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <string>

namespace heel {
namespace {

TickRecord record_of(SupervisorState state, StopReason reason) {
  TickRecord tick;
  tick.state = state;
  tick.stop_reason = reason;
  return tick;
}

TEST(StateSentence, SaysWhatTheRobotDoesAndWhy) {
  TickRecord tick = record_of(SupervisorState::Following, StopReason::None);
  EXPECT_EQ(state_sentence(tick), "following");
  tick.input.pose.template_index = 2;
  EXPECT_EQ(state_sentence(tick), "following by template 2");
  tick.free_distance_m = 0.416;
  tick.hold = Hold::ObstacleAhead;
  EXPECT_EQ(state_sentence(tick), "held: 0.42 m to an echo ahead");
  tick.person_m = 0.75;
  tick.hold = Hold::PersonTooNear;
  EXPECT_EQ(state_sentence(tick), "held: the person is 0.75 m away");
  EXPECT_EQ(state_sentence(record_of(SupervisorState::Searching, StopReason::TargetLost)),
            "searching: target lost");
}

TEST(StateSentence, NamesWhyNoPersonIsFollowed) {
  TickRecord tick = record_of(SupervisorState::Armed, StopReason::NoTargetYet);
  EXPECT_EQ(state_sentence(tick), "at rest: no target seen yet");
  tick.input.has_pose = true;
  tick.input.pose.reason = PoseReason::TooFewMatches;
  EXPECT_EQ(state_sentence(tick), "at rest: no target seen yet (too few matches)");
  tick.stop_reason = StopReason::StaleFrame;
  EXPECT_EQ(state_sentence(tick), "at rest: camera silent");
}

TEST(StateSentence, SaysWhatTheOperatorCanDo) {
  TickRecord tick = record_of(SupervisorState::Idle, StopReason::NotStarted);
  EXPECT_EQ(state_sentence(tick), "at rest: not started; `heel start` lets the robot move");
  tick = record_of(SupervisorState::Emergency, StopReason::EmergencyStop);
  EXPECT_EQ(state_sentence(tick), "at rest: emergency stop; `heel reset`, then `heel start`");
  tick = record_of(SupervisorState::Stopped, StopReason::StopButton);
  EXPECT_EQ(state_sentence(tick), "at rest: stop button pressed; release it, then `heel reset`");
  tick.stop_reason = StopReason::MotorsOff;
  EXPECT_EQ(state_sentence(tick), "at rest: motors off; `heel reset`, then `heel start`");
  tick.stop_reason = StopReason::Bumper;
  EXPECT_EQ(state_sentence(tick), "at rest: bumper pressed") << "it goes on by itself";
  tick.needs_start = true;
  EXPECT_EQ(state_sentence(tick), "at rest: bumper pressed; when it is over, `heel start`");
  tick.stop_reason = StopReason::Shutdown;
  EXPECT_EQ(state_sentence(tick), "at rest: shutting down");
}

template <std::size_t Size>
void name(std::array<char, Size>& out, const std::string& text) {
  std::copy(text.begin(), text.end(), out.begin());
}

TEST(StateSentence, SaysWhyARobotIsNotDriven) {
  TickRecord tick = record_of(SupervisorState::Idle, StopReason::LinkDown);
  tick.input.robot.phase = LinkPhase::Refused;
  RobotKind& kind = tick.input.robot.kind;
  name(kind.robot_class, "Roomba");
  name(kind.subclass, "create");
  kind.choice = ModelChoice::Unknown;
  EXPECT_EQ(state_sentence(tick),
            "at rest: the robot is not driven: heeld does not know class Roomba, subclass create");
  kind.subclass = {};
  EXPECT_TRUE(state_sentence(tick).ends_with("class Roomba, subclass ''")) << state_sentence(tick);
  name(kind.subclass, "create");
  kind.choice = ModelChoice::Conflict;
  EXPECT_EQ(state_sentence(tick),
            "at rest: the robot is not driven: it is a create, and robot.model says otherwise");
  kind.choice = ModelChoice::Nameless;
  EXPECT_EQ(state_sentence(tick),
            "at rest: the robot is not driven: it does not say what it is; set robot.model");
}

TEST(StateSentence, SaysWhatIsWrongWithThePicturesWhileNobodyIsFound) {
  TickRecord tick = record_of(SupervisorState::Waiting, StopReason::TargetLost);
  tick.input.has_pose = true;
  tick.input.pose.reason = PoseReason::TooFewFeatures;
  EXPECT_EQ(state_sentence(tick), "at rest: target lost (too few features)");
  tick.input.pose.picture = PictureFault::Dark;
  EXPECT_EQ(state_sentence(tick),
            "at rest: target lost (too few features); the picture is dark: is the lens "
            "covered, or the light off?");
  tick.input.pose.reason = PoseReason::Found;
  EXPECT_EQ(state_sentence(tick), "at rest: target lost");
  tick = record_of(SupervisorState::Stopped, StopReason::Bumper);
  tick.input.has_pose = true;
  tick.input.pose.picture = PictureFault::Dark;
  EXPECT_EQ(state_sentence(tick).find("dark"), std::string::npos) << "that is not why it rests";
}

TEST(PictureSentence, EachFaultHasItsOwn) {
  std::set<std::string> sentences;
  for (std::size_t i = 0; i < kPictureFaults; ++i)
    sentences.insert(picture_sentence(static_cast<PictureFault>(i)));
  EXPECT_EQ(sentences.size(), kPictureFaults) << "none: the empty one";
  EXPECT_EQ(picture_sentence(PictureFault::None), "");
}

/// All values of an enumeration have names, each its own, and the next value has none.
template <typename Enum>
void expect_names(std::size_t count) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < count; ++i) names.insert(to_string(static_cast<Enum>(i)));
  EXPECT_EQ(names.size(), count);
  EXPECT_EQ(names.count("?"), 0U);
  EXPECT_STREQ(to_string(static_cast<Enum>(count)), "?");
}

TEST(FlowNames, EachValueHasAName) {
  expect_names<SupervisorState>(kSupervisorStates);
  expect_names<TransitionCause>(kTransitionCauses);
  expect_names<OperatorCommand>(5);
  expect_names<OperatorOutcome>(4);
  expect_names<Hold>(3);
  expect_names<PictureFault>(kPictureFaults);
  expect_names<LinkPhase>(static_cast<std::size_t>(LinkPhase::Refused) + 1);
  expect_names<ModelChoice>(static_cast<std::size_t>(ModelChoice::Nameless) + 1);
  expect_names<StopReason>(static_cast<std::size_t>(StopReason::EmergencyStop) + 1);
}

}  // namespace
}  // namespace heel
