// A scene on disk for heeld: the template of a textured back, taken at 2 m; a calibration; a folder of frames
// that show the back farther away, so that the robot wants to drive; and a configuration that uses them.
#pragma once

#include <string>
#include <vector>

#include "support/temporary_folder.h"

namespace heel::test {

/// Lines added to the scene's configuration, and its supervisor.start.
struct MoreConfig {
  std::string sections{}, camera{}, runtime{}, robot{};
  std::string start = "at_once";
};

class Scene {
 public:
  /// `frames`: how many, at 25 a second (5 under sanitizers); each shows the back `distance_m` away.
  explicit Scene(int frames = 1000, double distance_m = 3.0);

  std::string path(const std::string& name) const { return folder_.file(name); }
  /// Writes heel.toml and returns its path. The sections [camera], [supervisor], [target], [robot],
  /// [operator] and [runtime] are in it: `more.camera`, `more.robot` and `more.runtime` are lines of their
  /// sections,
  /// `more.sections` comes at the end.
  std::string write_config(const MoreConfig& more = {}) const;

 private:
  void write_pictures(int frames, double distance_m) const;
  TemporaryFolder folder_;
};

/// A row of heel-sim's truth.
struct Truth {
  double t_s = 0.0;
  double v_m_s = 0.0;
};
std::vector<Truth> all_truth(const std::string& csv_path);
/// The newest complete row; zero when there is none yet.
Truth newest_truth(const std::string& csv_path);
/// When heel-sim last received bytes (its wire file), by CLOCK_MONOTONIC.
double last_received_s(const std::string& wire_path);
/// When heel-sim printed this event, by the time of its truth. Throws std::runtime_error when it did not.
double event_time_s(const std::string& log, const std::string& event);

}  // namespace heel::test
