// What the sonars heard in the last second, and whether a new echo is from something that has come.
//
// An echo at range r comes from anywhere on an arc: the width of the beam at r. Something that stands was on
// that arc before. Where every part of the arc lies in beams that were heard as free a moment ago, by
// whichever sonar and from where the robot was then, something has come there since: a person who walks, not
// a wall or a pole that the robot drives past. (The free part of a beam as evidence: H. Moravec, A. Elfes,
// "High Resolution Maps from Wide Angle Sonar", ICRA 1985.)
#pragma once

#include <array>
#include <cstddef>

#include "core/pose2.h"
#include "heel/flow.h"

namespace heel {

/// One reading: the sonar's pose in odom when it was read, the heading in the middle of its beam.
struct SonarBeam {
  TimeNs t_ns = 0;
  Pose2 sonar;
  double range_m = 0.0;
};

/// A ring of the newest readings of all sonars. Does not allocate.
class SonarBeams {
 public:
  void clear() { size_ = next_ = 0; }
  void add(const SonarBeam& beam);
  /// Whether the echo of `beam` is from something that was not there before. Compares it with the readings
  /// so far: call it before adding it.
  bool has_come(const SonarBeam& beam) const;

 private:
  bool heard_free(const SonarBeam& beam, double heading_rad) const;

  static constexpr std::size_t kCapacity = 64;  // two arrays of eight, a second and a bit
  std::array<SonarBeam, kCapacity> ring_{};
  std::size_t next_ = 0;
  std::size_t size_ = 0;
};

}  // namespace heel
