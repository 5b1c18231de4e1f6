// Camera calibration from views of a board, and the checks that its result can be trusted.
//
// Z. Zhang, "A Flexible New Technique for Camera Calibration", PAMI 2000, as OpenCV implements it.
#pragma once

#include <array>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "board_search.h"
#include "calibration_quality.h"
#include "heel/camera_model.h"

namespace heel::cli {

struct Calibration {
  CameraModel camera;
  double rms_px = 0.0;
  double fx_sigma_px = 0.0;
  double fy_sigma_px = 0.0;
  double largest_turn_deg = 0.0;         ///< the largest angle between the boards of two views
  std::array<double, 3> radial_sigma{};  ///< of k1, k2, k3
  EdgeErrors edges;
  std::string not_shown;  ///< parts_not_shown()
};

constexpr std::size_t kMinViews = 5;

/// `with_k3`: also estimates the third radial coefficient. Sets the views' errors.
Calibration calibrate_camera(const Board& board, cv::Size image_size, bool with_k3,
                             std::vector<BoardView>& views);

/// Throws heel::Error naming the views whose error is too large, or saying that the views do not determine
/// the focal length, or the directions at the edges of the picture, and what to add.
void require_good_calibration(const std::vector<BoardView>& views, const Calibration& calibration);

/// What a good calibration lacks, and what to add; empty when it lacks nothing.
std::string warning_of(const Calibration& calibration);
/// The same, and what is unusual of the camera, which more views do not change.
std::string warnings_of(const Calibration& calibration);

}  // namespace heel::cli
