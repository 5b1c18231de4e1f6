// Real pictures in the same harness: homography error on pairs whose truth is known, and certainty over a
// real video of a person from behind. The data are not part of heel (HEEL_TEST_DATA).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "heel/shirt_template.h"
#include "heel/vision_config.h"

namespace heel::evaluation {

/// A pair of the Oxford sets (K. Mikolajczyk et al., "A comparison of affine region detectors", IJCV 2005).
struct PairRow {
  std::string set;
  int to = 2;  ///< image 1 is the template, this the frame
  bool found = false;
  std::string reason;
  std::uint32_t inliers = 0;
  double certainty = 0.0;
  double corner_error_px = 0.0;  ///< mean over the image's corners
};

/// The sets there are below `data`/oxford: graf, boat, leuven; each to its images 2 … 6. Empty where absent.
std::vector<PairRow> look_at_pairs(const std::string& data, const VisionConfig& vision);

struct VideoRow {
  int frame = 0;
  bool found = false;
  double certainty = 0.0;
};

/// `data`/person/one-by-one.mp4 with the back of frame 1000 as the template; every `step`-th frame. Empty
/// where absent.
std::vector<VideoRow> look_at_video(const std::string& data, int step, const VisionConfig& vision);

/// The back comes into view whole at about the first and turns away after the last of these.
inline constexpr int kVideoFirstInView = 950, kVideoLastInView = 1170;

void write_pairs(const std::vector<PairRow>& rows, const std::string& path);
void write_video(const std::vector<VideoRow>& rows, const std::string& path);

}  // namespace heel::evaluation
