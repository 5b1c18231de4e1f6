// The supervisor: in every state every combination of conditions, command and circumstances; the answers to
// the operator; and what is so after each fault.
#include "control/supervisor.h"

#include <gtest/gtest.h>

#include <set>

#include "control/supervisor_oracle.h"

namespace heel {
namespace {

using State = SupervisorState;
using test::kAllCommands;
using test::kAllStates;

constexpr TimeNs kTick_ns = 20 * kNsPerMs;

/// A supervisor, tick by tick.
struct SupervisorBench {
  SupervisorConfig config;
  Supervisor supervisor;
  ControlInput input;
  bool law_may_search = false;
  Verdict last;

  explicit SupervisorBench(bool at_once = false)
      : config(at_once ? SupervisorConfig{.start = "at_once"} : SupervisorConfig{}), supervisor(config) {
    input.now_ns = 5 * kNsPerS;
  }
  const Verdict& tick(Conditions conditions, OperatorCommand command = OperatorCommand::None,
                      bool button_pressed = false) {
    input.now_ns += kTick_ns;
    input.robot.stop_button = button_pressed;
    if (command != OperatorCommand::None) input.request = {input.request.number + 1, input.now_ns, command};
    last = supervisor.update(input, conditions, law_may_search, config);
    return last;
  }
};

/// In the state that is wanted. `Idle` with `at_once`: not yet started.
SupervisorBench bench_in(State state, bool at_once = false) {
  SupervisorBench bench(at_once);
  if (state == State::Idle) {
    bench.tick(at_once ? kLinkDown : 0U);
    return bench;
  }
  bench.law_may_search = true;
  bench.tick(kNoTargetYet, at_once ? OperatorCommand::None : OperatorCommand::Start);
  if (state != State::Armed) bench.tick(0);
  if (state == State::Searching) bench.tick(kTargetLost);
  if (state == State::Waiting) bench.tick(kStaleFrame);
  if (state == State::Stopped) bench.tick(kBumper);
  if (state == State::Emergency) bench.tick(0, OperatorCommand::EStop);
  return bench;
}

TEST(Supervisor, TheBenchReachesEveryState) {
  for (const State state : kAllStates) {
    for (const bool at_once : {false, true}) EXPECT_EQ(bench_in(state, at_once).last.state, state);
  }
}

/// What holds of a verdict whatever led to it.
void expect_sound(const Verdict& verdict, State before, const SupervisorBench& bench, Conditions conditions,
                  OperatorCommand command) {
  const bool fault = (conditions & test::kFaultBits) != 0;
  const bool moves = verdict.style == StopStyle::Go;
  ASSERT_EQ(moves, (verdict.state == State::Following || verdict.state == State::Searching) && !fault);
  ASSERT_EQ(verdict.stop_reason == StopReason::None, verdict.state == State::Following);
  const bool stops = fault || verdict.state == State::Stopped || verdict.state == State::Emergency;
  ASSERT_EQ(verdict.style == StopStyle::AtOnce, stops);
  ASSERT_TRUE(command != OperatorCommand::EStop || verdict.state == State::Emergency);
  ASSERT_TRUE(before != State::Emergency || command == OperatorCommand::Reset || verdict.state == before);
  if (verdict.state != before) {
    ASSERT_EQ(verdict.t_transition_ns, bench.input.now_ns);
    ASSERT_EQ(verdict.cause, test::expected_cause(before, verdict.state, conditions, command));
  } else {
    ASSERT_LT(verdict.t_transition_ns, bench.input.now_ns);
  }
  ASSERT_EQ(verdict.request_number, bench.input.request.number);
  ASSERT_EQ(verdict.outcome == OperatorOutcome::Refused, verdict.refused_by != StopReason::None);
}

TEST(Supervisor, EveryStateWithEveryCombinationGoesWhereItShould) {
  std::uint64_t count = 0;
  for (const bool at_once : {false, true}) {
    for (const State before : kAllStates) {
      const SupervisorBench start = bench_in(before, at_once);
      for (Conditions conditions = 0; conditions <= kAllConditions; ++conditions) {
        for (const OperatorCommand command : kAllCommands) {
          for (const bool flag : {false, true}) {  // of the two that it stands for, each command reads one
            SupervisorBench bench = start;
            bench.law_may_search = flag;
            const Verdict& verdict = bench.tick(conditions, command, flag);
            const test::Circumstances circumstances{
                .button_pressed = flag, .at_once = at_once, .may_search = flag};
            ASSERT_EQ(verdict.state, test::expected_state(before, conditions, command, circumstances))
                << to_string(before) << " " << conditions << " " << to_string(command) << " " << flag;
            expect_sound(verdict, before, bench, conditions, command);
            if (testing::Test::HasFatalFailure())
              FAIL() << to_string(before) << " " << conditions << " " << to_string(command) << " " << flag;
            ++count;
          }
        }
      }
    }
  }
  EXPECT_EQ(count, 2U * 7U * (kAllConditions + 1U) * 5U * 2U);
}

TEST(Supervisor, AfterEachFaultItIsAtRestUntilAStart) {
  int faults = 0;
  for (const ConditionRow& row : kConditionTable) {
    if ((row.condition & test::kFaultBits) == 0) continue;
    ++faults;
    for (const State before : {State::Armed, State::Following, State::Searching, State::Waiting}) {
      SupervisorBench bench = bench_in(before);
      EXPECT_EQ(bench.tick(row.condition).state, State::Stopped);
      EXPECT_EQ(bench.last.cause, row.cause);
      EXPECT_EQ(bench.tick(row.condition, OperatorCommand::Start).outcome, OperatorOutcome::Refused);
      EXPECT_EQ(bench.last.refused_by, row.reason);
      for (int i = 0; i < 500; ++i) {
        bench.tick(0);
        ASSERT_EQ(bench.last.state, State::Stopped);
        ASSERT_EQ(bench.last.style, StopStyle::AtOnce);
        ASSERT_EQ(bench.last.stop_reason, row.reason);
        ASSERT_TRUE(bench.last.needs_start);
      }
      EXPECT_EQ(bench.tick(0, OperatorCommand::Start).state, State::Following);
      EXPECT_EQ(bench.last.outcome, OperatorOutcome::Done);
    }
  }
  EXPECT_EQ(faults, 12);
}

TEST(Supervisor, WithAtOnceItGoesOnAfterAFaultUnlessTheOperatorStopsIt) {
  SupervisorBench bench = bench_in(State::Following, true);
  bench.tick(kBumper);
  EXPECT_FALSE(bench.last.needs_start);
  EXPECT_EQ(bench.tick(0).state, State::Following);
  bench.tick(kBumper);
  EXPECT_EQ(bench.tick(kBumper, OperatorCommand::Stop).outcome, OperatorOutcome::AlreadySo);
  EXPECT_TRUE(bench.last.needs_start);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(bench.tick(0).state, State::Stopped);
  EXPECT_EQ(bench.tick(kBumper, OperatorCommand::Start).outcome, OperatorOutcome::Refused);
  EXPECT_EQ(bench.tick(0).state, State::Stopped) << "a start that was refused takes back no stop";
  EXPECT_EQ(bench.tick(0, OperatorCommand::Start).state, State::Following);
  bench.tick(0, OperatorCommand::Stop);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(bench.tick(0).state, State::Idle);
}

TEST(Supervisor, ASearchEndsAfterItsTime) {
  SupervisorBench bench = bench_in(State::Following);
  bench.law_may_search = true;
  bench.config.search_s = 1.0;
  const TimeNs t_lost_ns = bench.input.now_ns + kTick_ns;
  while (bench.tick(kTargetLost).state == State::Searching) ASSERT_LT(bench.input.now_ns, 60 * kNsPerS);
  EXPECT_EQ(bench.last.state, State::Waiting);
  EXPECT_EQ(bench.last.cause, TransitionCause::SearchEnded);
  EXPECT_EQ(bench.input.now_ns - t_lost_ns, kNsPerS + kTick_ns);
  EXPECT_EQ(bench.tick(kTargetLost).state, State::Waiting) << "a search does not begin again by itself";
  bench.tick(0);
  bench.config.search_s = 0.0;
  EXPECT_EQ(bench.tick(kTargetLost).state, State::Waiting) << "not asked for";
}

TEST(Supervisor, ARequestIsHandledOnce) {
  SupervisorBench bench = bench_in(State::Idle);
  bench.tick(0, OperatorCommand::Start);
  bench.tick(kBumper);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(bench.tick(0).state, State::Stopped) << "the start is an old one";
  EXPECT_EQ(bench.last.outcome, OperatorOutcome::Done) << "of the start";
}

TEST(Supervisor, AnOldRequestIsNotHandledAfterANewerOne) {
  SupervisorBench bench = bench_in(State::Idle);
  const OperatorRequest start{7, bench.input.now_ns, OperatorCommand::Start};
  bench.input.request.number = 7;
  bench.tick(0, OperatorCommand::EStop);
  bench.input.request = start;
  EXPECT_EQ(bench.tick(0).request_number, 8U);
  EXPECT_EQ(bench.last.state, State::Emergency);
}

TEST(Supervisor, AnswersSayWhatBecameOfARequest) {
  constexpr auto Start = OperatorCommand::Start, Stop = OperatorCommand::Stop, EStop = OperatorCommand::EStop,
                 Reset = OperatorCommand::Reset;
  constexpr auto Done = OperatorOutcome::Done, AlreadySo = OperatorOutcome::AlreadySo,
                 Refused = OperatorOutcome::Refused;
  struct Row {
    State state;
    OperatorCommand command;
    OperatorOutcome outcome;
  };
  constexpr Row kRows[] = {
      {State::Idle, Start, Done},           {State::Idle, Stop, AlreadySo},
      {State::Idle, EStop, Done},           {State::Idle, Reset, AlreadySo},
      {State::Armed, Start, AlreadySo},     {State::Armed, Stop, Done},
      {State::Armed, EStop, Done},          {State::Armed, Reset, AlreadySo},
      {State::Following, Start, AlreadySo}, {State::Following, Stop, Done},
      {State::Following, EStop, Done},      {State::Following, Reset, AlreadySo},
      {State::Searching, Start, AlreadySo}, {State::Searching, Stop, Done},
      {State::Searching, EStop, Done},      {State::Searching, Reset, AlreadySo},
      {State::Waiting, Start, AlreadySo},   {State::Waiting, Stop, Done},
      {State::Waiting, EStop, Done},        {State::Waiting, Reset, AlreadySo},
      {State::Stopped, Start, Done},        {State::Stopped, Stop, AlreadySo},
      {State::Stopped, EStop, Done},        {State::Stopped, Reset, Done},
      {State::Emergency, Start, Refused},   {State::Emergency, Stop, AlreadySo},
      {State::Emergency, EStop, AlreadySo}, {State::Emergency, Reset, Done},
  };
  for (const Row& row : kRows) {
    SupervisorBench bench = bench_in(row.state);
    EXPECT_EQ(bench.tick(0, row.command).outcome, row.outcome)
        << to_string(row.state) << " " << to_string(row.command);
    EXPECT_EQ(bench.last.enable_motors, row.command == Reset);
    EXPECT_FALSE(bench.tick(0).enable_motors) << "in the tick of the reset alone";
  }
  EXPECT_EQ(bench_in(State::Emergency).tick(0, Start).refused_by, StopReason::EmergencyStop);
}

TEST(Supervisor, AResetIsRefusedWhileTheButtonIsPressed) {
  for (const State state : kAllStates) {
    SupervisorBench bench = bench_in(state);
    bench.tick(kStopButton | kMotorsOff, OperatorCommand::Reset, true);
    EXPECT_EQ(bench.last.outcome, OperatorOutcome::Refused);
    EXPECT_EQ(bench.last.refused_by, StopReason::StopButton);
    EXPECT_FALSE(bench.last.enable_motors);
  }
  SupervisorBench bench = bench_in(State::Idle);
  EXPECT_EQ(bench.tick(kMotorsOff, OperatorCommand::Reset).outcome, OperatorOutcome::Done);
  EXPECT_TRUE(bench.last.enable_motors);
}

TEST(Supervisor, TheReasonNamesWhatKeepsTheRobotAtRest) {
  EXPECT_EQ(bench_in(State::Idle).last.stop_reason, StopReason::NotStarted);
  EXPECT_EQ(bench_in(State::Idle).tick(kLinkDown).stop_reason, StopReason::LinkDown);
  EXPECT_EQ(bench_in(State::Idle).tick(kNoTargetYet).stop_reason, StopReason::NotStarted);
  EXPECT_EQ(bench_in(State::Emergency).tick(kLinkDown).stop_reason, StopReason::EmergencyStop);
  EXPECT_EQ(bench_in(State::Emergency).tick(kShutdown).stop_reason, StopReason::Shutdown);
  EXPECT_EQ(bench_in(State::Stopped).tick(kLinkDown | kBumper).stop_reason, StopReason::LinkDown);
  EXPECT_EQ(bench_in(State::Stopped).tick(kTargetLost).stop_reason, StopReason::Bumper);
  EXPECT_EQ(bench_in(State::Waiting).tick(kTargetLost).stop_reason, StopReason::TargetLost);
}

}  // namespace
}  // namespace heel
