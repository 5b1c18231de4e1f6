// The experiments with still images by name: which poses, in which worlds.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "evaluation/experiments/progress_callback.h"
#include "evaluation/experiments/still_image_scene.h"

namespace heel::evaluation {

struct StillImageCase {
  std::string name;
  StillImageWorld world;
  StillImageView view;
};

struct StillImageExperiment {
  const char* name;
  const char* what;
  /// `repeats` of each pose, each in another world as far as there are worlds (`kMaxWorlds`).
  std::vector<StillImageCase> (*cases)(int repeats);
  int repeats;           ///< the default
  bool writes_pictures;  ///< DIR/NAME/NNN.png, one for each case
};

inline constexpr int kMaxWorlds = 8;

/// lateral, distance, yaw (the paper's Figures 2 … 6), hard (its Figure 1), errors (distributions, and the
/// data that the pose-noise model is fitted to).
const std::vector<StillImageExperiment>& still_image_experiments();

/// Takes the picture of a case with the case's index.
using PictureCallback = std::function<void(std::size_t index, const std::vector<std::uint8_t>& grey)>;

/// Renders and estimates all cases, two rows for each (StillImageScene::estimate_pair). `on_picture` is
/// called with the second picture of every case, `on_progress` after each world; both may be empty.
std::vector<StillImageRow> run_still_images(const sim::Scenario& base,
                                            const std::vector<StillImageCase>& cases, double teach_distance_m,
                                            const VisionConfig& vision, const PictureCallback& on_picture,
                                            const ProgressCallback& on_progress);

}  // namespace heel::evaluation
