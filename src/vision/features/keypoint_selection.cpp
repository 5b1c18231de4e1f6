#include "vision/features/keypoint_selection.h"

#include <algorithm>
#include <array>
#include <tuple>

namespace heel {
namespace {

constexpr int kGridColumns = 8;
constexpr int kGridRows = 6;
constexpr std::size_t kCells = kGridColumns * kGridRows;

std::size_t cell_of(const Feature& keypoint, const Region& region) {
  const float column =
      (keypoint.x_px - static_cast<float>(region.x_px)) * kGridColumns / static_cast<float>(region.width_px);
  const float row =
      (keypoint.y_px - static_cast<float>(region.y_px)) * kGridRows / static_cast<float>(region.height_px);
  return static_cast<std::size_t>(std::clamp(static_cast<int>(row), 0, kGridRows - 1) * kGridColumns +
                                  std::clamp(static_cast<int>(column), 0, kGridColumns - 1));
}

}  // namespace

bool stronger(const Feature& a, const Feature& b) {
  return std::tie(b.response, a.y_px, a.x_px, a.sigma_px) < std::tie(a.response, b.y_px, b.x_px, b.sigma_px);
}

KeypointSelection::KeypointSelection(std::size_t capacity) : capacity_(capacity) {
  keypoints_.reserve(2 * capacity_);
  ranking_.reserve(2 * capacity_);
}

void KeypointSelection::start(float threshold) {
  threshold_ = threshold;
  keypoints_.clear();
}

void KeypointSelection::add(const Feature& keypoint) {
  if (keypoint.response <= threshold_) return;
  keypoints_.push_back(keypoint);
  if (keypoints_.size() == 2 * capacity_) drop_weaker_half();
}

void KeypointSelection::drop_weaker_half() {
  const auto end = keypoints_.begin() + static_cast<std::ptrdiff_t>(capacity_);
  std::nth_element(keypoints_.begin(), end - 1, keypoints_.end(), stronger);
  keypoints_.erase(end, keypoints_.end());
  threshold_ = keypoints_.back().response;
}

void KeypointSelection::strongest(std::size_t count, std::vector<Feature>& out) {
  count = std::min(count, keypoints_.size());
  const auto end = keypoints_.begin() + static_cast<std::ptrdiff_t>(count);
  if (end != keypoints_.end()) std::nth_element(keypoints_.begin(), end, keypoints_.end(), stronger);
  std::sort(keypoints_.begin(), end, stronger);
  out.assign(keypoints_.begin(), end);
}

void KeypointSelection::strongest_spread(std::size_t count, const Region& region, std::vector<Feature>& out) {
  if (keypoints_.size() <= count) return strongest(count, out);
  // The largest share of a cell with which the sum does not exceed `count`. Cells with fewer keypoints than
  // that leave the others a larger share.
  std::array<std::size_t, kCells> in_cell{};
  for (const Feature& keypoint : keypoints_) ++in_cell[cell_of(keypoint, region)];
  const auto taken = [&](std::size_t share) {
    std::size_t sum = 0;
    for (const std::size_t n : in_cell) sum += std::min(n, share);
    return sum;
  };
  std::size_t share = 0;
  while (taken(share + 1) <= count) ++share;

  rank_all();
  std::array<std::size_t, kCells> used{};
  std::size_t left = count - taken(share);  // for the strongest of those beyond the shares
  out.clear();
  for (const Ranked& ranked : ranking_) {
    const Feature& keypoint = keypoints_[ranked.place];
    const bool within_share = used[cell_of(keypoint, region)]++ < share;
    if (!within_share && left == 0) continue;
    if (!within_share) --left;
    out.push_back(keypoint);
  }
}

/// Sorts places, which are quickly moved, in place of the keypoints.
void KeypointSelection::rank_all() {
  ranking_.clear();
  for (std::uint32_t place = 0; place < keypoints_.size(); ++place)
    ranking_.push_back({keypoints_[place].response, place});
  std::sort(ranking_.begin(), ranking_.end(), [this](const Ranked& a, const Ranked& b) {
    return a.response != b.response ? a.response > b.response
                                    : stronger(keypoints_[a.place], keypoints_[b.place]);
  });
}

}  // namespace heel
