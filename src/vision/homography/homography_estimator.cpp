// RANSAC for the homography: sample → minimal solver → MSAC cost → local optimisation of each new best →
// normalised DLT and Levenberg–Marquardt over the final consensus set.
// Everything runs in coordinates centred on the pairs' mean in each image (px, not scaled): there H(2,2), the
// w of the centroid, is never near zero, and floats are exact enough for scoring.
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/random.h"
#include "heel/homography.h"
#include "vision/homography/homography_4pt.h"
#include "vision/homography/homography_refine.h"
#include "vision/homography/homography_score.h"

namespace heel {
namespace {

constexpr int kLocalRounds = 2;  // DLT → new consensus → DLT
// Tukey's limit at 6 σ loses little of least squares' efficiency (5.1 σ: 5 % in the plane); the median of the
// squared error of two coordinates is 1.386 σ².
constexpr double kSoftLimitMedians = 6.0 * 6.0 / 1.386;
constexpr double kSoftLimitMin = 0.25, kSoftLimitMax = 6.0;  // of the inliers' limit

/// Samples needed to have drawn one of inliers only with the given confidence (H&Z, Eq. (4.18)).
int samples_needed(int inliers, int pairs, double confidence, int at_most) {
  const double good_sample = std::pow(static_cast<double>(inliers) / static_cast<double>(pairs), 4.0);
  if (good_sample >= 1.0) return 1;
  const double needed = std::log(1.0 - confidence) / std::log1p(-good_sample);
  return needed < at_most ? std::max(1, static_cast<int>(std::ceil(needed))) : at_most;
}

/// Four different indices below n ≥ 4.
std::array<std::size_t, 4> draw_sample(Random& random, std::uint32_t n) {
  std::array<std::size_t, 4> sample{};
  for (std::size_t i = 0; i < 4; ++i) {
    bool fresh = false;
    while (!fresh) {
      sample[i] = random.below(n);
      fresh = true;
      for (std::size_t k = 0; k < i; ++k) fresh = fresh && sample[k] != sample[i];
    }
  }
  return sample;
}

}  // namespace

struct HomographyEstimator::Impl {
  Impl(int max_pairs, const RansacSettings& given)
      : settings(given),
        limit_px2(2.0 * given.inlier_px * given.inlier_px),
        capacity(static_cast<std::size_t>(std::max(0, max_pairs))),
        table(capacity) {
    centred.reserve(capacity);
    consensus.reserve(capacity);
    consensus_index.reserve(capacity);
    errors_px2.reserve(capacity);
  }

  void load(std::span<const PointPair> pairs);
  void find_consensus(const Eigen::Matrix3d& H, double below_px2);
  bool sample_and_score(Random& random);
  void optimise_locally();
  double soft_limit_px2(const Eigen::Matrix3d& H);
  void polish();
  int search();
  RobustHomography report(int iterations, std::vector<std::uint8_t>& inlier_mask) const;

  RansacSettings settings;
  double limit_px2;
  std::size_t capacity;

  Eigen::Vector2d ref_centre_px, cur_centre_px;
  std::vector<PointPair> centred;  // every pair, centred
  ScoreTable table;                // the same as floats
  Eigen::Matrix3d best_H;
  float best_cost_px2 = 0.f;
  bool any_sample_solved = false;
  std::vector<PointPair> consensus;  // of the last find_consensus
  std::vector<std::uint32_t> consensus_index;
  std::vector<double> errors_px2;
};

void HomographyEstimator::Impl::load(std::span<const PointPair> pairs) {
  ref_centre_px.setZero();
  cur_centre_px.setZero();
  for (const PointPair& pair : pairs) {
    ref_centre_px += pair.ref_px;
    cur_centre_px += pair.cur_px;
  }
  ref_centre_px /= static_cast<double>(pairs.size());
  cur_centre_px /= static_cast<double>(pairs.size());
  centred.clear();
  table.clear();
  for (const PointPair& pair : pairs) {
    centred.push_back({pair.ref_px - ref_centre_px, pair.cur_px - cur_centre_px});
    table.add(centred.back().ref_px, centred.back().cur_px);
  }
  best_cost_px2 = std::numeric_limits<float>::infinity();
  any_sample_solved = false;
  consensus.clear();
  consensus_index.clear();
}

void HomographyEstimator::Impl::find_consensus(const Eigen::Matrix3d& H, double below_px2) {
  const Eigen::Matrix3d H_inverse = H.inverse();
  consensus.clear();
  consensus_index.clear();
  for (std::size_t i = 0; i < centred.size(); ++i) {
    if (symmetric_transfer_error_px2(H, H_inverse, centred[i]) >= below_px2) continue;
    if (H.row(2).dot(centred[i].ref_px.homogeneous()) <= 0.0) continue;  // behind a camera
    consensus.push_back(centred[i]);
    consensus_index.push_back(static_cast<std::uint32_t>(i));
  }
}

/// Draws one sample; true when its homography is the best so far.
bool HomographyEstimator::Impl::sample_and_score(Random& random) {
  const std::array<std::size_t, 4> sample = draw_sample(random, static_cast<std::uint32_t>(centred.size()));
  std::array<Eigen::Vector2d, 4> ref_px, cur_px;
  for (std::size_t i = 0; i < 4; ++i) {
    ref_px[i] = centred[sample[i]].ref_px;
    cur_px[i] = centred[sample[i]].cur_px;
  }
  Eigen::Matrix3d H;
  if (!homography_4pt(ref_px, cur_px, H)) return false;
  any_sample_solved = true;
  const float cost_px2 = table.cost_px2(H, static_cast<float>(limit_px2), best_cost_px2);
  if (!(cost_px2 < best_cost_px2)) return false;
  best_cost_px2 = cost_px2;
  best_H = H;
  return true;
}

/// Least squares over the best's consensus set, as long as that makes it better.
void HomographyEstimator::Impl::optimise_locally() {
  find_consensus(best_H, limit_px2);
  for (int round = 0; round < kLocalRounds && consensus.size() > 4; ++round) {
    Eigen::Matrix3d H;
    if (homography_dlt(consensus, H) != HomographyStatus::Ok) return;
    const float cost_px2 = table.cost_px2(H, static_cast<float>(limit_px2), best_cost_px2);
    if (!(cost_px2 < best_cost_px2)) return;
    best_cost_px2 = cost_px2;
    best_H = H;
    find_consensus(best_H, limit_px2);
  }
}

/// Samples until a better one is too unlikely or the iterations are used up.
int HomographyEstimator::Impl::search() {
  Random random(settings.seed);
  const int pairs = static_cast<int>(centred.size());
  int needed = settings.max_iterations;
  int iterations = 0;
  while (iterations < needed) {
    ++iterations;
    if (!sample_and_score(random)) continue;
    optimise_locally();
    needed = samples_needed(static_cast<int>(consensus.size()), pairs, settings.confidence,
                            settings.max_iterations);
  }
  return iterations;
}

/// Where the refinement's loss becomes constant: as many standard deviations of the noise (seen in the
/// consensus set's median error) as keep the efficiency of least squares, whatever the threshold was set to.
double HomographyEstimator::Impl::soft_limit_px2(const Eigen::Matrix3d& H) {
  const Eigen::Matrix3d H_inverse = H.inverse();
  errors_px2.clear();
  for (const PointPair& pair : consensus)
    errors_px2.push_back(symmetric_transfer_error_px2(H, H_inverse, pair));
  const auto middle = errors_px2.begin() + static_cast<std::ptrdiff_t>(errors_px2.size() / 2);
  std::nth_element(errors_px2.begin(), middle, errors_px2.end());
  return std::clamp(kSoftLimitMedians * *middle, kSoftLimitMin * limit_px2, kSoftLimitMax * limit_px2);
}

/// Normalised DLT over the consensus set, then the local refinement, which lets go of the hard threshold:
/// pairs just outside it still pull a little, those just inside it no longer with full weight.
void HomographyEstimator::Impl::polish() {
  find_consensus(best_H, limit_px2);
  if (consensus.size() <= 4) return;
  Eigen::Matrix3d H;
  if (homography_dlt(consensus, H) != HomographyStatus::Ok) H = best_H;
  const double soft_px2 = soft_limit_px2(H);
  find_consensus(H, soft_px2);
  refine_homography(consensus, soft_px2, H);
  best_H = H;
  find_consensus(best_H, limit_px2);
}

RobustHomography HomographyEstimator::Impl::report(int iterations,
                                                   std::vector<std::uint8_t>& inlier_mask) const {
  RobustHomography result;
  result.iterations = iterations;
  if (!any_sample_solved) {
    result.status = HomographyStatus::Degenerate;
    return result;
  }
  if (consensus.size() <= 4) {
    result.status = HomographyStatus::NoConsensus;
    return result;
  }
  result.status = HomographyStatus::Ok;
  result.inliers = static_cast<int>(consensus.size());
  for (const std::uint32_t i : consensus_index) inlier_mask[i] = 1;

  // Back to image coordinates, linear in the entries: H = C H_centred R ...
  const Eigen::Matrix3d H_centred = best_H / best_H(2, 2);
  Eigen::Matrix3d C = Eigen::Matrix3d::Identity(), R = Eigen::Matrix3d::Identity();
  C.col(2).head<2>() = cur_centre_px;
  R.col(2).head<2>() = -ref_centre_px;
  const Eigen::Matrix3d H = C * H_centred * R;
  const double h = std::abs(H(2, 2)) > 1e-12 * H.norm() ? H(2, 2) : H.norm();
  result.H_cur_from_ref = H / h;
  if (!settings.precision) return result;

  const HomographyPrecision precision = homography_precision(consensus, H_centred);
  result.rms_px = precision.rms_px;
  Matrix9d L;
  for (int i = 0; i < 9; ++i)
    for (int k = 0; k < 9; ++k) L(i, k) = C(i / 3, k / 3) * R(k % 3, i % 3);
  // ... and to H(2,2) = 1: d(H / h) = (dH − (H / h) dh) / h.
  Matrix9d scaling = Matrix9d::Identity() / h;
  for (int i = 0; i < 9; ++i) scaling(i, 8) -= result.H_cur_from_ref(i / 3, i % 3) / h;
  const Matrix9d J = scaling * L;
  result.covariance = J * precision.covariance * J.transpose();
  return result;
}

HomographyEstimator::HomographyEstimator(int max_pairs, const RansacSettings& settings)
    : impl_(std::make_unique<Impl>(max_pairs, settings)) {}
HomographyEstimator::~HomographyEstimator() = default;
HomographyEstimator::HomographyEstimator(HomographyEstimator&&) noexcept = default;
HomographyEstimator& HomographyEstimator::operator=(HomographyEstimator&&) noexcept = default;

RobustHomography HomographyEstimator::estimate(std::span<const PointPair> pairs,
                                               std::vector<std::uint8_t>& inlier_mask) {
  inlier_mask.assign(pairs.size(), 0);
  pairs = pairs.first(std::min(pairs.size(), impl_->capacity));
  if (pairs.size() < 4) return {};
  impl_->load(pairs);
  const int iterations = impl_->search();
  if (impl_->any_sample_solved) impl_->polish();
  return impl_->report(iterations, inlier_mask);
}

}  // namespace heel
