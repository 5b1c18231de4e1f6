// Commands on their way through a control loop that the test plays.
#include "operator/commands.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace heel {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using Tickets = std::vector<std::uint64_t>;

constexpr TimeNs kNow_ns = 10 * kNsPerS;

struct ScriptedPort final : OperatorPort {
  OperatorRequest request(OperatorCommand command, TimeNs t_ns) override {
    requests.push_back({requests.size() + 1, t_ns, command});
    return requests.back();
  }
  void alive(TimeNs) override {}
  bool take_tick(TickRecord&) override { return false; }
  CaptureCounters camera() override { return {}; }
  void answered(const std::string&, const std::string&, const std::string&) override {}
  std::string mark(const std::string&) override { return ""; }
  std::vector<OperatorRequest> requests;
};

TickRecord handled(std::uint64_t number, SupervisorState state,
                   OperatorOutcome outcome = OperatorOutcome::Done) {
  TickRecord tick;
  tick.request_number = number;
  tick.state = state;
  tick.outcome = outcome;
  return tick;
}

Tickets tickets_of(const std::vector<CommandResult>& results) {
  Tickets tickets;
  for (const CommandResult& result : results) tickets.push_back(result.ticket);
  return tickets;
}

class Commands : public ::testing::Test {
 protected:
  ScriptedPort port_;
  CommandQueue commands_{port_};
  const TickRecord nothing_;
};

TEST_F(Commands, AnEmergencyStopOfAnotherAskerTakesTheirPlace) {
  commands_.add(OperatorCommand::Start, 1, kNow_ns);
  port_.request(OperatorCommand::EStop, kNow_ns);  // the page's
  const auto results = commands_.settle(handled(2, SupervisorState::Emergency), kNow_ns);
  ASSERT_THAT(results, SizeIs(1));
  EXPECT_EQ(results[0].error, "not done: an emergency stop came before it was handled");
  commands_.add(OperatorCommand::Reset, 2, kNow_ns);
  EXPECT_EQ(port_.requests.back().number, 3u) << "newer than that of the other asker";
}

TEST_F(Commands, AreAnsweredAfterTheTickThatHandledThem) {
  commands_.add(OperatorCommand::Start, 1, kNow_ns);
  ASSERT_THAT(port_.requests, SizeIs(1));
  EXPECT_EQ(port_.requests[0].command, OperatorCommand::Start);
  EXPECT_THAT(commands_.settle(nothing_, kNow_ns), IsEmpty());
  EXPECT_TRUE(commands_.busy());
  const auto results = commands_.settle(handled(port_.requests[0].number, SupervisorState::Armed), kNow_ns);
  ASSERT_THAT(results, SizeIs(1));
  EXPECT_EQ(results[0].outcome, OperatorOutcome::Done);
  EXPECT_EQ(results[0].error, "");
  EXPECT_FALSE(commands_.busy());
}

TEST_F(Commands, ARefusalNamesItsReason) {
  commands_.add(OperatorCommand::Start, 1, kNow_ns);
  TickRecord tick = handled(1, SupervisorState::Stopped, OperatorOutcome::Refused);
  tick.refused_by = StopReason::StopButton;
  EXPECT_EQ(commands_.settle(tick, kNow_ns).at(0).error, "refused: stop button pressed");
}

TEST_F(Commands, OneAfterAnotherInOrder) {
  for (std::uint64_t ticket = 1; ticket <= 3; ++ticket)
    commands_.add(ticket == 2 ? OperatorCommand::Stop : OperatorCommand::Start, ticket, kNow_ns);
  EXPECT_THAT(port_.requests, SizeIs(1));
  EXPECT_EQ(tickets_of(commands_.settle(handled(1, SupervisorState::Armed), kNow_ns)), Tickets{1});
  ASSERT_THAT(port_.requests, SizeIs(2));
  EXPECT_EQ(port_.requests[1].command, OperatorCommand::Stop);
  EXPECT_EQ(tickets_of(commands_.settle(handled(2, SupervisorState::Idle), kNow_ns)), Tickets{2});
  EXPECT_THAT(port_.requests, SizeIs(3));
}

TEST_F(Commands, AnEmergencyStopGoesAtOnceAndGivesUpWhatWaits) {
  commands_.add(OperatorCommand::Start, 1, kNow_ns);
  commands_.add(OperatorCommand::Reset, 2, kNow_ns);
  commands_.add(OperatorCommand::EStop, 3, kNow_ns);
  ASSERT_THAT(port_.requests, SizeIs(2))
      << "the reset has not gone, and must not go after the emergency stop";
  EXPECT_EQ(port_.requests[1].command, OperatorCommand::EStop);
  auto results = commands_.settle(nothing_, kNow_ns);
  EXPECT_EQ(tickets_of(results), (Tickets{1, 2}));
  for (const CommandResult& result : results)
    EXPECT_THAT(result.error, HasSubstr("an emergency stop came before"));
  commands_.add(OperatorCommand::Reset, 4, kNow_ns);
  EXPECT_THAT(port_.requests, SizeIs(2)) << "a reset waits for the emergency stop to be handled";
  results = commands_.settle(handled(2, SupervisorState::Emergency), kNow_ns);
  EXPECT_EQ(tickets_of(results), Tickets{3});
  EXPECT_EQ(results[0].outcome, OperatorOutcome::Done);
  ASSERT_THAT(port_.requests, SizeIs(3));
  EXPECT_EQ(port_.requests[2].command, OperatorCommand::Reset);
  EXPECT_EQ(tickets_of(commands_.settle(handled(3, SupervisorState::Idle), kNow_ns)), Tickets{4});
  EXPECT_FALSE(commands_.busy()) << "what was given up is not done later";
}

TEST_F(Commands, TwoEmergencyStopsInOneTickAreBothAnswered) {
  commands_.add(OperatorCommand::EStop, 1, kNow_ns);
  commands_.add(OperatorCommand::EStop, 2, kNow_ns);
  EXPECT_THAT(port_.requests, SizeIs(2));
  const auto results = commands_.settle(handled(2, SupervisorState::Emergency), kNow_ns);
  EXPECT_EQ(tickets_of(results), (Tickets{1, 2}));
  for (const CommandResult& result : results) EXPECT_EQ(result.error, "");
}

TEST_F(Commands, AnEmergencyStopThatDidNotStopIsAnError) {
  commands_.add(OperatorCommand::EStop, 1, kNow_ns);
  EXPECT_EQ(commands_.settle(handled(1, SupervisorState::Stopped), kNow_ns).at(0).error,
            "the state is stopped (expected emergency)");
}

TEST_F(Commands, ACommandThatTheLoopDoesNotTakeIsWithdrawn) {
  commands_.add(OperatorCommand::Start, 1, kNow_ns);
  EXPECT_THAT(commands_.settle(nothing_, kNow_ns + CommandQueue::kPatience_ns), IsEmpty());
  const auto results = commands_.settle(nothing_, kNow_ns + CommandQueue::kPatience_ns + 1);
  ASSERT_THAT(results, SizeIs(1));
  EXPECT_THAT(results[0].error, HasSubstr("did not answer within 0.5 s; the request is withdrawn"));
  ASSERT_THAT(port_.requests, SizeIs(2));
  EXPECT_EQ(port_.requests[1].command, OperatorCommand::None);
  EXPECT_GT(port_.requests[1].number, port_.requests[0].number);
}

TEST_F(Commands, ACommandThatWaitedTooLongForThoseBeforeItIsNotDone) {
  commands_.add(OperatorCommand::Stop, 1, kNow_ns);
  commands_.add(OperatorCommand::Start, 2, kNow_ns + 1);
  commands_.add(OperatorCommand::Start, 3, kNow_ns + 20 * kNsPerMs);
  const TimeNs late_ns = kNow_ns + CommandQueue::kPatience_ns + 2;
  const auto results = commands_.settle(handled(1, SupervisorState::Idle), late_ns);
  EXPECT_EQ(tickets_of(results), (Tickets{1, 2}));
  EXPECT_EQ(results.at(1).error, "not done: it waited more than 0.5 s for those before it");
  EXPECT_THAT(port_.requests, SizeIs(2)) << "the third is not too old";
}

TEST_F(Commands, AnEmergencyStopThatTheLoopDoesNotTakeIsNotWithdrawn) {
  commands_.add(OperatorCommand::EStop, 1, kNow_ns);
  const auto results = commands_.settle(nothing_, kNow_ns + CommandQueue::kPatience_ns + 1);
  ASSERT_THAT(results, SizeIs(1));
  EXPECT_THAT(results[0].error, HasSubstr("it stops when it runs again"));
  EXPECT_THAT(port_.requests, SizeIs(1));
}

TEST_F(Commands, NotMoreWaitThanTheBound) {
  for (std::uint64_t ticket = 0; ticket < CommandQueue::kMaxWaiting + 5; ++ticket)
    commands_.add(OperatorCommand::Stop, ticket, kNow_ns);
  const auto results = commands_.settle(nothing_, kNow_ns);
  ASSERT_THAT(results, SizeIs(4)) << "one has gone, the bound waits";
  for (const CommandResult& result : results) EXPECT_THAT(result.error, HasSubstr("commands wait already"));
}

}  // namespace
}  // namespace heel
