/// \file
/// The homography between two views of a plane: normalised DLT, RANSAC with symmetric transfer error, least
/// squares over the consensus set.
///
/// - Convention: x_cur ~ H_cur_from_ref x_ref, scaled so that H(2,2) = 1 where that is possible.
/// - Units: undistorted pixels; squared errors in px².
/// - Errors: a named HomographyStatus; nothing throws.
/// - Source: R. Hartley, A. Zisserman, "Multiple View Geometry in Computer Vision", 2nd ed., 2003, 4.1 to
///   4.8 and 5.2. Local optimisation: O. Chum, J. Matas, J. Kittler, "Locally Optimized RANSAC", DAGM 2003.
///   MSAC's cost: P. Torr, A. Zisserman, "MLESAC", CVIU 78(1), 2000.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace heel {

/// A pair of matched points, undistorted pixels.
struct PointPair {
  Eigen::Vector2d ref_px;
  Eigen::Vector2d cur_px;
};

/// Why there is a homography, or none.
enum class HomographyStatus : std::uint8_t {
  Ok,
  TooFewPairs,  ///< fewer than four
  Degenerate,   ///< three collinear points, or a matrix without full rank, in every sample tried
  NoConsensus,  ///< no sample had more support than its own four pairs
};

/// Normalised DLT over four or more pairs. Degenerate when the second smallest singular value is tiny
/// relative to the largest.
HomographyStatus homography_dlt(std::span<const PointPair> pairs, Eigen::Matrix3d& H_cur_from_ref);

/// Symmetric transfer error, squared: |x_cur − H x_ref|² + |x_ref − H⁻¹ x_cur|² (px²).
double symmetric_transfer_error_px2(const Eigen::Matrix3d& H_cur_from_ref,
                                    const Eigen::Matrix3d& H_ref_from_cur, const PointPair& pair);

/// When a pair supports a sample, and when the search ends.
struct RansacSettings {
  double inlier_px = 3.0;      ///< an inlier's symmetric transfer error is below 2 · inlier_px²
  double confidence = 0.999;   ///< probability that no better sample exists at which the search stops
  int max_iterations = 10000;  ///< enough for confidence 0.999 when 83 % of the pairs are wrong
  std::uint64_t seed = 1;
  bool precision = true;  ///< compute rms_px and covariance as well
};

/// What the search found; a homography only when the status is Ok.
struct RobustHomography {
  HomographyStatus status = HomographyStatus::TooFewPairs;
  Eigen::Matrix3d H_cur_from_ref = Eigen::Matrix3d::Identity();
  int inliers = 0;
  int iterations = 0;
  double rms_px = 0.0;  ///< one-way error of the inliers in the current image, root mean square
  /// Covariance of the nine entries (row-major, H(2,2) = 1 fixed), from the inliers' residuals; px units of
  /// H.
  Eigen::Matrix<double, 9, 9> covariance = Eigen::Matrix<double, 9, 9>::Zero();
};

/// RANSAC with local optimisation and MSAC's cost. Memory is taken once for `max_pairs`; pairs beyond that
/// many are left out.
///
/// Every call starts from the seed and reads no clock, so the same pairs give the same result; only work
/// space is kept between calls. `max_iterations` alone bounds the time.
///
/// The plane is assumed to be opaque and in front of both cameras: a mirrored homography is never returned.
class HomographyEstimator {
 public:
  HomographyEstimator(int max_pairs, const RansacSettings& settings);
  ~HomographyEstimator();
  HomographyEstimator(HomographyEstimator&&) noexcept;
  HomographyEstimator& operator=(HomographyEstimator&&) noexcept;

  /// `inlier_mask` (resized within capacity) says which pairs support the result.
  RobustHomography estimate(std::span<const PointPair> pairs, std::vector<std::uint8_t>& inlier_mask);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace heel
