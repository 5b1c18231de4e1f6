// Many runs at a glance: a band for each.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace heel::evaluation {

struct OverviewBand {
  std::string title;
  std::string text;  ///< beneath the title
  cv::Mat path;      ///< path_figure(); empty: no picture
  cv::Mat frames;    ///< frames_figure(); empty: none
};

/// Bands one under the other: path, and the frames from the middle of the run.
cv::Mat overview_figure(const std::vector<OverviewBand>& bands);

}  // namespace heel::evaluation
