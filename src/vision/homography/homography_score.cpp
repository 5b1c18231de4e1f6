#include "vision/homography/homography_score.h"

#include <Eigen/Geometry>

namespace heel {
namespace {

constexpr float kPadding_px = 1e8f;  // the coordinate of a padding pair, far from any image

/// The inverse up to the positive factor det H: the same map, and cheaper.
Eigen::Matrix3d adjugate(const Eigen::Matrix3d& H) {
  Eigen::Matrix3d inverse;
  inverse.row(0) = H.col(1).cross(H.col(2));
  inverse.row(1) = H.col(2).cross(H.col(0));
  inverse.row(2) = H.col(0).cross(H.col(1));
  return inverse;
}

}  // namespace

ScoreTable::ScoreTable(std::size_t max_pairs) {
  const std::size_t padded = (max_pairs + kLanes - 1) / kLanes * kLanes;
  for (std::vector<float>* column : {&ref_x_, &ref_y_, &cur_x_, &cur_y_}) column->resize(padded, kPadding_px);
}

void ScoreTable::clear() {
  size_ = 0;
}

void ScoreTable::add(const Eigen::Vector2d& ref_px, const Eigen::Vector2d& cur_px) {
  ref_x_[size_] = static_cast<float>(ref_px.x());
  ref_y_[size_] = static_cast<float>(ref_px.y());
  cur_x_[size_] = static_cast<float>(cur_px.x());
  cur_y_[size_] = static_cast<float>(cur_px.y());
  ++size_;
  for (std::size_t i = size_; i % kLanes != 0; ++i) {  // fill up the last group of lanes
    ref_x_[i] = ref_y_[i] = 0.f;
    cur_x_[i] = cur_y_[i] = kPadding_px;
  }
}

float ScoreTable::cost_px2(const Eigen::Matrix3d& H_cur_from_ref, float limit_px2, float stop_above) const {
  using Rows = Eigen::Matrix<float, 3, 3, Eigen::RowMajor>;
  const Rows F = H_cur_from_ref.cast<float>();
  const Rows B = adjugate(H_cur_from_ref).cast<float>();
  const float f0 = F(0, 0), f1 = F(0, 1), f2 = F(0, 2), f3 = F(1, 0), f4 = F(1, 1), f5 = F(1, 2),
              f6 = F(2, 0), f7 = F(2, 1), f8 = F(2, 2);
  const float b0 = B(0, 0), b1 = B(0, 1), b2 = B(0, 2), b3 = B(1, 0), b4 = B(1, 1), b5 = B(1, 2),
              b6 = B(2, 0), b7 = B(2, 1), b8 = B(2, 2);
  const std::size_t tail =
      (kLanes - size_ % kLanes) % kLanes;  // number of padding pairs; each costs the limit
  const float padding_cost = static_cast<float>(tail) * limit_px2;

  float sums[kLanes] = {};
  float total = 0.f;
  for (std::size_t begin = 0; begin < size_; begin += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const float xr = ref_x_[begin + lane], yr = ref_y_[begin + lane];
      const float xc = cur_x_[begin + lane], yc = cur_y_[begin + lane];
      const float wf = f6 * xr + f7 * yr + f8;
      const float wb = b6 * xc + b7 * yc + b8;
      const float dxf = (f0 * xr + f1 * yr + f2) / wf - xc;
      const float dyf = (f3 * xr + f4 * yr + f5) / wf - yc;
      const float dxb = (b0 * xc + b1 * yc + b2) / wb - xr;
      const float dyb = (b3 * xc + b4 * yc + b5) / wb - yr;
      const float error = dxf * dxf + dyf * dyf + dxb * dxb + dyb * dyb;
      const float nearest_w = wf < wb ? wf : wb;
      const float capped = error < limit_px2 ? error : limit_px2;  // NaN (w = 0) is capped too
      sums[lane] += nearest_w > 0.f ? capped : limit_px2;
    }
    total = ((sums[0] + sums[1]) + (sums[2] + sums[3])) + ((sums[4] + sums[5]) + (sums[6] + sums[7]));
    if (total - padding_cost > stop_above) return total - padding_cost;
  }
  return total - padding_cost;
}

}  // namespace heel
