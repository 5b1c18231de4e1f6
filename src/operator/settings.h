// The configuration of the running daemon: the values of its file, those that an operator has set since, and
// what changes them: set, save, reload. Each is all or nothing.
#pragma once

#include <functional>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "config/config_load.h"
#include "config/config_set.h"

namespace heel {

/// What the daemon does for its settings.
struct SettingsHooks {
  /// Throws heel::Error when the values do not fit the daemon's inputs.
  std::function<void(const Config&)> check;
  /// Takes the values over. Throws heel::Error when that fails; nothing has changed then.
  std::function<void(const Config&)> apply;
};

struct SettingsView {
  Config file;    ///< the values of the file
  Config in_use;  ///< and with those that were set
};

class Settings {
 public:
  Settings(LoadedConfig loaded, SettingsHooks hooks);

  // One thread calls these three; they throw ConfigError or Error with the reason, and then nothing has
  // changed.
  /// What has changed.
  std::vector<ConfigChange> set(std::span<const ConfigAssignment> assignments);
  /// Writes what was set into the file; empty: there was nothing to write. A file of which values have
  /// changed since it was read is refused.
  std::vector<ConfigChange> save();
  /// Reads the file again. What was set and not saved is dropped, and returned: from the value set to the one
  /// of the file.
  std::vector<ConfigChange> reload();

  // From any thread:
  const std::string& file() const { return file_; }
  SettingsView view() const;

 private:
  const std::string file_;
  LoadedConfig loaded_;  // as the file has it
  Config in_use_;
  SettingsHooks hooks_;

  void publish();
  mutable std::mutex mutex_;  // of the view
  SettingsView view_;
};

}  // namespace heel
