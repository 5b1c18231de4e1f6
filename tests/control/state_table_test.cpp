// The table of states: it has no circle, each of its rows is needed, and the manual shows it.
#include "control/state_table.h"

#include <gtest/gtest.h>

#include <vector>

#include "control/state_manual.h"
#include "control/supervisor_oracle.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace heel {
namespace {

constexpr int kMostSteps = 3;  // Idle → Armed → Following is two

struct Led {
  SupervisorState state;
  TransitionCause cause = TransitionCause::Boot;
  int steps = 0;
  bool operator==(const Led&) const = default;
};

/// Where a table leads in one tick.
Led led_to(std::span<const StateRow> table, SupervisorState state, SupervisorFacts facts) {
  Led led{state};
  while (const StateRow* const row = next_row(led.state, facts, table)) {
    led.state = row->to;
    led.cause = cause_of(row->trigger, facts.conditions);
    facts.command = OperatorCommand::None;
    facts.first_start = false;
    if (++led.steps > kMostSteps) break;
  }
  return led;
}

/// Where the rules lead.
Led expected(SupervisorState before, const SupervisorFacts& facts) {
  Led led{test::expected_state(before, facts.conditions, facts.command,
                               {facts.button_pressed, facts.resumes, facts.may_search})};
  if (led.state != before)
    led.cause = test::expected_cause(before, led.state, facts.conditions, facts.command);
  // One step, or two where a start finds the target good.
  const bool start = before == SupervisorState::Idle || before == SupervisorState::Stopped;
  led.steps = led.state == before ? 0 : start && led.state == SupervisorState::Following ? 2 : 1;
  return led;
}

/// Calls `visit` with every combination of facts, with one condition of each kind for all of it.
template <typename Visit>
void for_all_facts(Visit visit) {
  for (const Conditions faults : {Conditions{0}, Conditions{kBumper}}) {
    for (const Conditions senses : {Conditions{0}, Conditions{kStaleFrame}}) {
      for (const Conditions target : {Conditions{0}, Conditions{kTargetLost}}) {
        for (const OperatorCommand command : test::kAllCommands) {
          for (int flags = 0; flags < 8; ++flags) {
            SupervisorFacts facts;
            facts.conditions = faults | senses | target;
            facts.command = command;
            facts.button_pressed = (flags & 1) != 0;
            facts.first_start = facts.resumes = (flags & 2) != 0;
            facts.may_search = (flags & 4) != 0;
            visit(facts);
          }
        }
      }
    }
  }
}

/// How often the table leads elsewhere than the rules do.
int differences(std::span<const StateRow> table) {
  int count = 0;
  for_all_facts([&](SupervisorFacts facts) {
    for (const SupervisorState state : test::kAllStates) {
      // As the supervisor reads its facts: a command ends the waiting for the first start.
      SupervisorFacts read = facts;
      read.first_start = facts.first_start && facts.command == OperatorCommand::None;
      read.resumes = facts.resumes && facts.command != OperatorCommand::Stop;
      count += !(led_to(table, state, read) == expected(state, facts));
    }
  });
  return count;
}

TEST(StateTable, LeadsWhereTheRulesSay) {
  EXPECT_EQ(differences(kStateTable), 0);
}

TEST(StateTable, HasNoCircle) {
  for_all_facts([](SupervisorFacts facts) {
    for (const SupervisorState state : test::kAllStates)
      ASSERT_LT(led_to(kStateTable, state, facts).steps, kMostSteps) << to_string(state);
  });
}

TEST(StateTable, EachChangedRowIsFound) {
  const std::vector<StateRow> table(std::begin(kStateTable), std::end(kStateTable));
  int changes = 0;
  for (std::size_t i = 0; i < table.size(); ++i) {
    std::vector<StateRow> without = table;
    without.erase(without.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_GT(differences(without), 0) << "row " << i << " is missing";
    ++changes;
    for (const SupervisorState to : test::kAllStates) {
      std::vector<StateRow> changed = table;
      if (to == table[i].to) continue;
      changed[i].to = to;
      EXPECT_GT(differences(changed), 0) << "row " << i << " leads to " << to_string(to);
      ++changes;
    }
    for (std::size_t trigger = 0; trigger < kTriggers; ++trigger) {
      std::vector<StateRow> changed = table;
      changed[i].trigger = static_cast<Trigger>(trigger);
      if (changed[i].trigger == table[i].trigger) continue;
      EXPECT_GT(differences(changed), 0) << "row " << i << " by trigger " << trigger;
      ++changes;
    }
  }
  EXPECT_EQ(changes, static_cast<int>(table.size() * (1 + 6 + 11)));
}

TEST(StateTable, TheManualShowsIt) {
  const std::string manual = test::read_text(test::source_path("docs/safety.md"));
  EXPECT_NE(manual.find(state_manual_text()), std::string::npos)
      << "docs/safety.md: its tables are not those of `heeld --print-state-manual`";
}

}  // namespace
}  // namespace heel
