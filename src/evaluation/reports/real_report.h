// Real pictures: DIR/real_pairs.csv and DIR/real_video.csv as a table and a figure.
#pragma once

#include <opencv2/core.hpp>
#include <string>

namespace heel::evaluation {

/// Markdown; says what was skipped where a file is absent.
std::string real_section(const std::string& directory);
/// Certainty over the video's frames; empty when absent.
cv::Mat video_figure(const std::string& directory);

}  // namespace heel::evaluation
