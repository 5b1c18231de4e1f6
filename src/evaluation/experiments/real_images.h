// Vision on real pictures: the homography error on image pairs whose true homography is known, and the
// certainty over a real video of a person from behind. The data are not part of heel (HEEL_TEST_DATA).
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
  int to = 2;  ///< number of the image that is the frame; image 1 is the template
  bool found = false;
  std::string reason;
  std::uint32_t inliers = 0;
  double certainty = 0.0;
  double corner_error_px = 0.0;  ///< mean over the image's corners
};

/// The pairs of image 1 with images 2 … 6 of the sets graf, boat and leuven, as far as they are below
/// `data`/oxford.
std::vector<PairRow> estimate_pairs(const std::string& data, const VisionConfig& vision);

struct VideoRow {
  int frame = 0;
  bool found = false;
  double certainty = 0.0;
};

/// Every `step`-th frame of `data`/person/one-by-one.mp4, with the back in frame 1000 as the template. Empty
/// when there is no such file.
std::vector<VideoRow> estimate_video(const std::string& data, int step, const VisionConfig& vision);

/// About the first frame that shows the whole back, and the last before the person turns away.
inline constexpr int kVideoFirstInView = 950, kVideoLastInView = 1170;

void write_pairs(const std::vector<PairRow>& rows, const std::string& path);
void write_video(const std::vector<VideoRow>& rows, const std::string& path);

}  // namespace heel::evaluation
