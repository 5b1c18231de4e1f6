// A scene on disk for heeld: a textured back, its template taken at 2 m, a camera file, a folder of frames
// that show it farther away (so that the robot wants to drive), and a configuration that ties them together.
#pragma once

#include <string>
#include <vector>

#include "support/temporary_folder.h"

namespace heel::test {

class Scene {
 public:
  /// `frames`: how many, at 25 a second (5 under sanitizers); each shows the back `distance_m` away.
  explicit Scene(int frames = 1000, double distance_m = 3.0);

  std::string path(const std::string& name) const { return folder_.file(name); }
  /// Writes heel.toml with `more` appended, and returns its path.
  std::string write_config(const std::string& more = "") const;

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

}  // namespace heel::test
