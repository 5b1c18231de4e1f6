// RANSAC for the homography: sample → minimal solver → MSAC cost → local optimisation of each new best →
// normalised DLT and Levenberg–Marquardt over the final consensus set.
//
// Coordinates are centred on the mean of the pairs in each image (px, not scaled). There H(2,2), the w of the
// centroid, is never near zero, and floats are exact enough for the cost.
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "core/random.h"
#include "heel/homography.h"
#include "vision/homography/homography_4pt.h"
#include "vision/homography/homography_refine.h"
#include "vision/homography/homography_score.h"

namespace heel {
namespace {

constexpr int kLocalRounds = 2;  // DLT → new consensus → DLT
// Tukey's loss with its limit at 6 σ loses little efficiency against least squares (5 % at 5.1 σ in the
// plane). The median of the squared error of two coordinates is 1.386 σ².
constexpr double kSoftLimitMedians = 6.0 * 6.0 / 1.386;
constexpr double kSoftLimitMin = 0.25, kSoftLimitMax = 6.0;  // of the inlier limit

/// The number of samples of which, with the given confidence, at least one has inliers only (H&Z, Eq.
/// (4.18)).
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

/// A homography in centred coordinates, and how well it fits.
struct ScoredHomography {
  Eigen::Matrix3d H = Eigen::Matrix3d::Identity();
  float cost_px2 = std::numeric_limits<float>::infinity();
  int inliers = 0;
};

/// What the samples gave.
struct SearchResult {
  ScoredHomography best;
  bool any_sample_solved = false;
  int iterations = 0;
};

/// The pairs that support a homography, and their indices. Views of the work space, valid until the next
/// consensus.
struct Consensus {
  std::span<const PointPair> pairs;
  std::span<const std::uint32_t> indices;
};

struct PolishedHomography {
  Eigen::Matrix3d H;  ///< centred
  Consensus consensus;
};

}  // namespace

struct HomographyEstimator::Impl {
  Impl(int max_pairs, const RansacSettings& given)
      : settings(given),
        limit_px2(2.0 * given.inlier_px * given.inlier_px),
        capacity(static_cast<std::size_t>(std::max(0, max_pairs))),
        table(capacity) {
    centred.reserve(capacity);
    consensus_pairs.reserve(capacity);
    consensus_indices.reserve(capacity);
    errors_px2.reserve(capacity);
  }

  void load(std::span<const PointPair> pairs);
  bool solve_sample(Random& random, Eigen::Matrix3d& H) const;
  Consensus consensus_of(const Eigen::Matrix3d& H, double below_px2);
  ScoredHomography optimise_locally(ScoredHomography candidate);
  SearchResult search();
  double soft_limit_px2(const Eigen::Matrix3d& H, std::span<const PointPair> consensus);
  PolishedHomography polish(const Eigen::Matrix3d& H);
  RobustHomography in_image_coordinates(const PolishedHomography& polished) const;

  RansacSettings settings;
  double limit_px2;
  std::size_t capacity;

  // The problem, written by load().
  Eigen::Vector2d ref_centre_px, cur_centre_px;
  std::vector<PointPair> centred;  // every pair, centred
  ScoreTable table;                // the same as floats
  // Work space: written and read within one step.
  std::vector<PointPair> consensus_pairs;
  std::vector<std::uint32_t> consensus_indices;
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
}

bool HomographyEstimator::Impl::solve_sample(Random& random, Eigen::Matrix3d& H) const {
  const std::array<std::size_t, 4> sample = draw_sample(random, static_cast<std::uint32_t>(centred.size()));
  std::array<Eigen::Vector2d, 4> ref_px, cur_px;
  for (std::size_t i = 0; i < 4; ++i) {
    ref_px[i] = centred[sample[i]].ref_px;
    cur_px[i] = centred[sample[i]].cur_px;
  }
  return homography_4pt(ref_px, cur_px, H);
}

Consensus HomographyEstimator::Impl::consensus_of(const Eigen::Matrix3d& H, double below_px2) {
  const Eigen::Matrix3d H_inverse = H.inverse();
  consensus_pairs.clear();
  consensus_indices.clear();
  for (std::size_t i = 0; i < centred.size(); ++i) {
    if (symmetric_transfer_error_px2(H, H_inverse, centred[i]) >= below_px2) continue;
    if (H.row(2).dot(centred[i].ref_px.homogeneous()) <= 0.0) continue;  // behind a camera
    consensus_pairs.push_back(centred[i]);
    consensus_indices.push_back(static_cast<std::uint32_t>(i));
  }
  return {consensus_pairs, consensus_indices};
}

/// Least squares over the consensus set, repeated as long as it lowers the cost.
ScoredHomography HomographyEstimator::Impl::optimise_locally(ScoredHomography candidate) {
  Consensus consensus = consensus_of(candidate.H, limit_px2);
  for (int round = 0; round < kLocalRounds && consensus.pairs.size() > 4; ++round) {
    Eigen::Matrix3d H;
    if (homography_dlt(consensus.pairs, H) != HomographyStatus::Ok) break;
    const float cost_px2 = table.cost_px2(H, static_cast<float>(limit_px2), candidate.cost_px2);
    if (!(cost_px2 < candidate.cost_px2)) break;
    candidate.H = H;
    candidate.cost_px2 = cost_px2;
    consensus = consensus_of(H, limit_px2);
  }
  candidate.inliers = static_cast<int>(consensus.pairs.size());
  return candidate;
}

/// Draws samples until a better one is improbable enough or the iterations are used up.
SearchResult HomographyEstimator::Impl::search() {
  Random random(settings.seed);
  SearchResult result;
  ScoredHomography& best = result.best;
  int needed = settings.max_iterations;
  while (result.iterations < needed) {
    ++result.iterations;
    Eigen::Matrix3d H;
    if (!solve_sample(random, H)) continue;
    result.any_sample_solved = true;
    const float cost_px2 = table.cost_px2(H, static_cast<float>(limit_px2), best.cost_px2);
    if (!(cost_px2 < best.cost_px2)) continue;
    best = optimise_locally({H, cost_px2, 0});
    needed = samples_needed(best.inliers, static_cast<int>(centred.size()), settings.confidence,
                            settings.max_iterations);
  }
  return result;
}

/// Where the loss of the refinement becomes constant: a multiple of the noise (estimated from the median
/// error of the consensus set) that keeps the efficiency of least squares, whatever the inlier limit is.
double HomographyEstimator::Impl::soft_limit_px2(const Eigen::Matrix3d& H,
                                                 std::span<const PointPair> consensus) {
  const Eigen::Matrix3d H_inverse = H.inverse();
  errors_px2.clear();
  for (const PointPair& pair : consensus)
    errors_px2.push_back(symmetric_transfer_error_px2(H, H_inverse, pair));
  const auto middle = errors_px2.begin() + static_cast<std::ptrdiff_t>(errors_px2.size() / 2);
  std::nth_element(errors_px2.begin(), middle, errors_px2.end());
  return std::clamp(kSoftLimitMedians * *middle, kSoftLimitMin * limit_px2, kSoftLimitMax * limit_px2);
}

/// Normalised DLT over the consensus set, then the refinement with a soft limit: pairs just outside the
/// inlier limit keep a small weight, pairs just inside it have less than the full weight.
PolishedHomography HomographyEstimator::Impl::polish(const Eigen::Matrix3d& H_best) {
  const Consensus consensus = consensus_of(H_best, limit_px2);
  if (consensus.pairs.size() <= 4) return {H_best, consensus};
  Eigen::Matrix3d H;
  if (homography_dlt(consensus.pairs, H) != HomographyStatus::Ok) H = H_best;
  const double soft_px2 = soft_limit_px2(H, consensus.pairs);
  refine_homography(consensus_of(H, soft_px2).pairs, soft_px2, H);
  return {H, consensus_of(H, limit_px2)};
}

RobustHomography HomographyEstimator::Impl::in_image_coordinates(const PolishedHomography& polished) const {
  RobustHomography result;
  result.status = HomographyStatus::Ok;
  result.inliers = static_cast<int>(polished.consensus.pairs.size());

  // Linear in the entries: H = C H_centred R ...
  const Eigen::Matrix3d H_centred = polished.H / polished.H(2, 2);
  Eigen::Matrix3d C = Eigen::Matrix3d::Identity(), R = Eigen::Matrix3d::Identity();
  C.col(2).head<2>() = cur_centre_px;
  R.col(2).head<2>() = -ref_centre_px;
  const Eigen::Matrix3d H = C * H_centred * R;
  const double h = std::abs(H(2, 2)) > 1e-12 * H.norm() ? H(2, 2) : H.norm();
  result.H_cur_from_ref = H / h;
  if (!settings.precision) return result;

  const HomographyPrecision precision = homography_precision(polished.consensus.pairs, H_centred);
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
  const SearchResult found = impl_->search();
  RobustHomography result;
  result.status = HomographyStatus::Degenerate;
  if (found.any_sample_solved) {
    const PolishedHomography polished = impl_->polish(found.best.H);
    result.status = HomographyStatus::NoConsensus;
    if (polished.consensus.pairs.size() > 4) {
      result = impl_->in_image_coordinates(polished);
      for (const std::uint32_t i : polished.consensus.indices) inlier_mask[i] = 1;
    }
  }
  result.iterations = found.iterations;
  return result;
}

}  // namespace heel
