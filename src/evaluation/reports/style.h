// What all figures share: colours and units.
#pragma once

#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

namespace heel::evaluation {

inline constexpr double kDeg = 180.0 / M_PI;
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

inline const cv::Scalar kOrange(40, 130, 230), kBlue(170, 80, 20), kGreen(60, 140, 60), kRed(40, 40, 200),
    kGrey(150, 150, 150);
inline const cv::Scalar kPerson = kOrange, kRobot = kBlue;

}  // namespace heel::evaluation
