#include "operator/settings_loop.h"

#include <spdlog/spdlog.h>

#include <exception>
#include <utility>

namespace heel {
namespace {

void log_changes(const char* what, const std::vector<ConfigChange>& changes) {
  for (const ConfigChange& change : changes)
    spdlog::info("{} {}: {} -> {}", what, change.key, change.before, change.after);
}

}  // namespace

void SettingsLoop::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return stop_ || !jobs_.empty(); });
    if (stop_) return;
    const SettingsJob job = std::move(jobs_.front());
    jobs_.pop_front();
    lock.unlock();
    SettingsAnswer answer = do_job(job);
    lock.lock();
    if (job.kind == SettingsJobKind::Reload) {
      ++reloads_;
    } else {
      answers_.push_back(std::move(answer));
    }
    lock.unlock();
    if (on_answer_) on_answer_();
    lock.lock();
  }
}

SettingsAnswer SettingsLoop::do_job(const SettingsJob& job) {
  SettingsAnswer answer{job.kind, job.ticket, {}, {}};
  try {
    switch (job.kind) {
      case SettingsJobKind::Set:
        answer.changes = settings_.set(job.assignments);
        log_changes(fmt::format("{} set", job.who).c_str(), answer.changes);
        break;
      case SettingsJobKind::Save:
        answer.changes = settings_.save();
        log_changes(fmt::format("{} saved", job.who).c_str(), answer.changes);
        break;
      case SettingsJobKind::Reload:
        answer.changes = settings_.reload();
        log_changes("the reload drops what was set and not saved:", answer.changes);
        break;
    }
  } catch (const ConfigError& error) {
    answer.errors = error.lines();
  } catch (const std::exception& error) {
    answer.errors = {error.what()};
  }
  if (job.kind != SettingsJobKind::Reload) return answer;
  for (const std::string& line : answer.errors) spdlog::error("{}", line);
  if (answer.errors.empty()) {
    spdlog::info("reloaded {}", settings_.file());
  } else {
    spdlog::error("reload refused: the old configuration stays in use");
  }
  return answer;
}

void SettingsLoop::stop() {
  const std::lock_guard lock(mutex_);
  stop_ = true;
  changed_.notify_all();
}

bool SettingsLoop::post(SettingsJob job) {
  const std::lock_guard lock(mutex_);
  if (jobs_.size() >= kMaxWaiting) return false;
  jobs_.push_back(std::move(job));
  changed_.notify_all();
  return true;
}

bool SettingsLoop::take(SettingsAnswer& out) {
  const std::lock_guard lock(mutex_);
  if (answers_.empty()) return false;
  out = std::move(answers_.front());
  answers_.pop_front();
  return true;
}

std::uint64_t SettingsLoop::reloads() const {
  const std::lock_guard lock(mutex_);
  return reloads_;
}

}  // namespace heel
