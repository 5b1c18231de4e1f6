// Searching for shirts where they are not: each template of a foreign set in the pictures of all other
// prints, and in a video of other people.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "evaluation/experiments/foreign_set.h"
#include "heel/vision_config.h"

namespace heel::evaluation {

struct FalseDetections {
  std::string searched_for;  ///< "blobs, logo and photo prints"
  std::string in;
  std::size_t pictures = 0;
  std::vector<std::string> found;  ///< which picture or frame, and with which certainty
};

/// Every template in every still that shows another print, each picture by itself.
FalseDetections search_other_prints(const ForeignSet& set, const ForeignTemplates& templates,
                                    const VisionConfig& vision);

/// Every template in every frame of a video that shows none of them, as a sequence. The video's camera is not
/// known; a usual focal length is assumed.
FalseDetections search_video(const std::string& path, const ForeignTemplates& templates,
                             const VisionConfig& vision);

void write_false_detections(const std::vector<FalseDetections>& all, const std::string& path);

}  // namespace heel::evaluation
