// How far the printed card is from the camera, in a picture in which a person holds it against the back.
//
// Camera frame x right, y down, z forward; the distance is along z, as heel teach takes it.
// Errors: heel::Error, which says what is wrong with the card in the picture.
#pragma once

#include <opencv2/core/mat.hpp>

#include "heel/camera_model.h"

namespace heel::cli {

struct CardDistance {
  double distance_m = 0.0;  ///< to the middle of the card
  /// One standard deviation: by how exactly the corners are found, and by what printers and calibrations
  /// usually miss.
  double sigma_m = 0.0;
  double tilt_rad = 0.0;  ///< between the card's normal and the line of sight
  double rms_px = 0.0;    ///< of the corners against a flat card
};

/// `square_m`: side of a square as printed.
CardDistance distance_of_card(const cv::Mat& grey, const CameraModel& camera, double square_m);

}  // namespace heel::cli
