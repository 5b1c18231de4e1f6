// The loop of the settings thread: what changes the configuration, one job after another. A save waits for
// the disk, and a set for the control loop's next tick: the operator thread, which serves the emergency stop,
// must not.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "operator/settings.h"

namespace heel {

enum class SettingsJobKind : std::uint8_t { Set, Save, Reload };

struct SettingsJob {
  SettingsJobKind kind = SettingsJobKind::Reload;
  std::uint64_t ticket = 0;  ///< the asker's; the answer has it
  std::string who{};         ///< for the log
  std::vector<ConfigAssignment> assignments{};
};

struct SettingsAnswer {
  SettingsJobKind kind = SettingsJobKind::Reload;
  std::uint64_t ticket = 0;
  std::vector<ConfigChange> changes;
  std::vector<std::string> errors;  ///< empty: done
};

class SettingsLoop {
 public:
  static constexpr std::size_t kMaxWaiting = 16;

  explicit SettingsLoop(Settings& settings) : settings_(settings) {}
  /// Before run(): `tell` is called in the settings thread when the answer to a job can be taken.
  void on_answer(std::function<void()> tell) { on_answer_ = std::move(tell); }

  /// Until stop(); a job that runs is finished, and those that wait are not done.
  void run();
  // From any thread:
  void stop();
  /// False: too many jobs wait.
  bool post(SettingsJob job);
  /// The oldest answer to a set or a save.
  bool take(SettingsAnswer& out);
  /// The number of reloads that have ended, done or refused.
  std::uint64_t reloads() const;

 private:
  SettingsAnswer do_job(const SettingsJob& job);

  Settings& settings_;
  std::function<void()> on_answer_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  // Guarded by mutex_:
  std::deque<SettingsJob> jobs_;
  std::deque<SettingsAnswer> answers_;
  std::uint64_t reloads_ = 0;
  bool stop_ = false;
};

}  // namespace heel
