#include "vision/patches/patch_aligner.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "vision/patches/patch_sums.h"

namespace heel {
namespace {

constexpr double kMinArea = 0.01;  // of a visible patch, current to reference image
constexpr int kMinHalf_px = 4, kMaxHalf_px = (kMaxPatchSide - 3) / 2;  // of a patch in the frame
constexpr int kIterations = 8;
constexpr double kPatchSettled_px = 0.03;
// Standard deviation of grey levels below which a patch is plain.
constexpr float kPlainReference = 5.f, kPlainFrame = 2.f;
// Along an edge the place is undetermined; the damping keeps it where it is.
constexpr double kDamping = 0.02;
// Neighbouring grey levels differ from the reference in the same way: so many count as one. The rest of the
// noise, 4 grey levels squared, is the camera's.
constexpr double kAlikeSamples = 4.0, kCameraNoise2 = 4.0;

struct Candidate {
  double gradient;
  Eigen::Vector2d px;
};

double gradient_of(const GreyPyramid& reference, const Eigen::Vector2d& centre_px, double half_size_px) {
  const int half_px = static_cast<int>(half_size_px);
  const auto at = [&](double dx, double dy) { return reference.at(centre_px + Eigen::Vector2d(dx, dy)); };
  double sum = 0.0, count = 0.0;
  for (int dy = -half_px; dy <= half_px; ++dy) {
    for (int dx = -half_px; dx <= half_px; ++dx) {
      const double gx = 0.5 * (at(dx + 1.0, dy) - at(dx - 1.0, dy));
      const double gy = 0.5 * (at(dx, dy + 1.0) - at(dx, dy - 1.0));
      sum += gx * gx + gy * gy;
      count += 1.0;
    }
  }
  return std::sqrt(sum / count);
}

std::vector<Eigen::Vector2d> choose_centres(const GreyPyramid& reference, const Region& roi,
                                            const PatchSettings& settings) {
  std::vector<Candidate> candidates;
  // Of the cells of a grid, those whose centre lies inside.
  const int rows = static_cast<int>(std::ceil(roi.height_px / settings.spacing_px - 0.5));
  const int columns = static_cast<int>(std::ceil(roi.width_px / settings.spacing_px - 0.5));
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const Eigen::Vector2d px(roi.x_px + (column + 0.5) * settings.spacing_px,
                               roi.y_px + (row + 0.5) * settings.spacing_px);
      const double gradient = gradient_of(reference, px, settings.half_size_px);
      if (gradient >= settings.min_gradient) candidates.push_back({gradient, px});
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.gradient > b.gradient; });
  std::vector<Eigen::Vector2d> centres;
  for (const Candidate& candidate : candidates)
    if (centres.size() < settings.max_patches) centres.push_back(candidate.px);
  return centres;
}

}  // namespace

bool PredictedPatch::visible() const {
  return cur_from_ref.determinant() > kMinArea;
}

PatchAligner::PatchAligner(const ShirtTemplate& shirt, const PatchSettings& settings)
    : settings_(settings),
      reference_(shirt.grey, shirt.camera.width_px, shirt.camera.height_px),
      centres_px_(choose_centres(reference_, shirt.roi, settings)) {}

void PatchAligner::align(const FrameView& frame, std::span<const PredictedPatch> predicted,
                         std::vector<AlignedPatch>& out) const {
  out.clear();
  for (std::size_t i = 0; i < centres_px_.size(); ++i)
    if (const std::optional<AlignedPatch> aligned = align_one(frame, i, predicted[i]))
      out.push_back(*aligned);
}

/// Gauss–Newton on the normalised correlation of the reference patch, warped to the frame, with the frame.
std::optional<AlignedPatch> PatchAligner::align_one(const FrameView& frame, std::size_t patch,
                                                    const PredictedPatch& predicted) const {
  if (!predicted.visible()) return std::nullopt;
  const double scale = std::sqrt(predicted.cur_from_ref.determinant());
  const int half =
      std::clamp(static_cast<int>(std::lround(settings_.half_size_px * scale)), kMinHalf_px, kMaxHalf_px);
  const int side = 2 * half + 1;
  PatchSamples warped;  // with a border for the gradients
  if (!reference_.sample(centres_px_[patch], predicted.cur_from_ref.inverse(), side + 2, warped))
    return std::nullopt;
  const PatchModel model(warped, side);
  if (model.variance() < kPlainReference * kPlainReference) return std::nullopt;

  const Eigen::Matrix2d hessian = model.hessian();
  const Eigen::Matrix2d step_from_gradient =
      (hessian + kDamping * hessian.trace() * Eigen::Matrix2d::Identity()).inverse();
  Eigen::Vector2d shift_px = Eigen::Vector2d::Zero();
  double correlation = 0.0;
  for (int i = 0; i < kIterations; ++i) {
    const std::optional<PatchComparison> seen =
        model.compare(frame, predicted.px + shift_px - Eigen::Vector2d::Constant(half));
    if (!seen || seen->variance < kPlainFrame * kPlainFrame) return std::nullopt;
    correlation = seen->correlation;
    const Eigen::Vector2d step_px = step_from_gradient * seen->gradient;
    shift_px -= step_px;
    if (!(shift_px.norm() < settings_.max_shift_px)) return std::nullopt;
    if (step_px.norm() < kPatchSettled_px) break;
  }
  if (correlation < settings_.min_correlation) return std::nullopt;
  const double noise2 = kAlikeSamples * 2.0 * (1.0 - correlation) * model.variance() + kCameraNoise2;
  return AlignedPatch{patch, predicted.px + shift_px, hessian / noise2};
}

}  // namespace heel
