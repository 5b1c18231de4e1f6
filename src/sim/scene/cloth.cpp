#include "sim/scene/cloth.h"

#include <cmath>
#include <numbers>

#include "core/random.h"
#include "sim/scene/back_shape.h"

namespace heel::sim {
namespace {

// A wave vector drawn with deviation 1/length makes a field whose correlation falls as exp(−d²/2 length²)
// (A. Rahimi and B. Recht, "Random features for large-scale kernel machines", 2007).
constexpr double kFoldShortest_m = 0.05, kFoldLongest_m = 0.16;
constexpr double kDrag_m = 0.075;
// Walking cloth, by the share of its waves: a quarter stays as it has settled, a third repeats with the
// stride, the rest comes from the cloth's own swinging. At the usual 1.2 s a stride this makes a correlation
// of about 0.6 after 67 ms, none after 200 ms, and 0.4 to 0.5 a stride later.
constexpr double kStill = 0.2, kPeriodic = 0.45;
constexpr double kSwing = 2.3;  ///< deviation of the other waves' rates
// Slow components, relative to the drag: a keystone at the corners of the back, a stretch at its upper and
// lower edge.
constexpr double kKeystone = 1.0, kStretch = 0.28;

}  // namespace

Cloth::Cloth(std::uint64_t seed, const ClothGrid& grid) : seed_(seed), grid_(grid) {
  Random random(derived_seed(seed, 1));
  for (std::size_t i = 0; i < kWaves; ++i) {
    const double length_m = i < kFolds ? random.uniform(kFoldShortest_m, kFoldLongest_m) : kDrag_m;
    Wave& wave = waves_[i];
    wave.ks = random.normal() / length_m;
    wave.kz = random.normal() / length_m;
    const double kind = random.uniform();
    const double swing = kSwing * random.normal();
    const double side = random.uniform() < 0.5 ? -1.0 : 1.0;
    if (kind < kStill)
      wave.rate = 0.0;
    else if (kind < kStill + kPeriodic)
      wave.rate = side * (random.uniform() < 0.5 ? 1.0 : 2.0);
    else
      wave.rate = swing;
    for (const double s_m : grid.s_m) {
      cos_.push_back(static_cast<float>(std::cos(wave.ks * s_m)));
      sin_.push_back(static_cast<float>(std::sin(wave.ks * s_m)));
    }
  }
}

Cloth::Shifts::Shifts(const Cloth& cloth, const ClothState& state)
    : cloth_(cloth),
      fold_amplitude_m_(static_cast<float>(state.fold_m * std::sqrt(2.0 / kFolds))),
      drag_amplitude_m_(static_cast<float>(state.drag_m * std::sqrt(2.0 / kDrags))) {
  Random random(derived_seed(cloth.seed_, 0x100 + state.settling));
  for (std::size_t i = 0; i < kWaves; ++i)
    phase_[i] = 2.0 * std::numbers::pi * random.uniform() + cloth.waves_[i].rate * state.stride_rad;
  keystone_m_ = kKeystone * state.drag_m * random.normal();
  stretch_m_ = kStretch * state.drag_m * random.normal();
  // The twist swings with the stride, the hollow of the back with the steps.
  twist_m_ =
      state.pull_m * random.normal() * std::cos(state.stride_rad + 2.0 * std::numbers::pi * random.uniform());
  hollow_m_ = state.pull_m * random.normal() *
              std::cos(2.0 * state.stride_rad + 2.0 * std::numbers::pi * random.uniform());
}

void Cloth::Shifts::add_slow(double s_m, double z_m, ClothShift& shift) const {
  const double u = s_m / kBackHalfWidth_m;
  const double v = (kBackMiddleZ_m - z_m) / kBackHalfHeight_m;
  shift.normal_m += static_cast<float>(twist_m_ * u * v + hollow_m_ * v * v);
  shift.slope_around += static_cast<float>(twist_m_ * v / kBackHalfWidth_m);
  shift.slope_up -= static_cast<float>((twist_m_ * u + 2.0 * hollow_m_ * v) / kBackHalfHeight_m);
  shift.up_m += static_cast<float>(keystone_m_ * u * v + stretch_m_ * v);
}

ClothShift Cloth::Shifts::at(double s_m, double z_m) const {
  ClothShift shift;
  for (std::size_t i = 0; i < kWaves; ++i) {
    const Wave& wave = cloth_.waves_[i];
    const double angle = wave.ks * s_m + wave.kz * z_m + phase_[i];
    const auto c = static_cast<float>(std::cos(angle));
    if (i < kFolds) {
      const auto s = static_cast<float>(std::sin(angle));
      shift.normal_m += fold_amplitude_m_ * c;
      shift.slope_around -= fold_amplitude_m_ * static_cast<float>(wave.ks) * s;
      shift.slope_up -= fold_amplitude_m_ * static_cast<float>(wave.kz) * s;
    } else {
      (i < kFolds + kDrags ? shift.around_m : shift.up_m) += drag_amplitude_m_ * c;
    }
  }
  add_slow(s_m, z_m, shift);
  return shift;
}

void Cloth::Shifts::row(std::size_t index, std::vector<ClothShift>& shifts) const {
  const std::size_t columns = cloth_.grid_.s_m.size();
  const double z_m = cloth_.grid_.z_m[index];
  shifts.assign(columns, {});
  for (std::size_t i = 0; i < kWaves; ++i) {
    const Wave& wave = cloth_.waves_[i];
    const auto cz = static_cast<float>(std::cos(wave.kz * z_m + phase_[i]));
    const auto sz = static_cast<float>(std::sin(wave.kz * z_m + phase_[i]));
    const float* cs = cloth_.cos_.data() + i * columns;
    const float* ss = cloth_.sin_.data() + i * columns;
    if (i < kFolds) {
      const float ks = fold_amplitude_m_ * static_cast<float>(wave.ks);
      const float kz = fold_amplitude_m_ * static_cast<float>(wave.kz);
      for (std::size_t j = 0; j < columns; ++j) {
        const float sine = ss[j] * cz + cs[j] * sz;
        shifts[j].normal_m += fold_amplitude_m_ * (cs[j] * cz - ss[j] * sz);
        shifts[j].slope_around -= ks * sine;
        shifts[j].slope_up -= kz * sine;
      }
    } else {
      float ClothShift::*const way = i < kFolds + kDrags ? &ClothShift::around_m : &ClothShift::up_m;
      for (std::size_t j = 0; j < columns; ++j)
        shifts[j].*way += drag_amplitude_m_ * (cs[j] * cz - ss[j] * sz);
    }
  }
  for (std::size_t j = 0; j < columns; ++j) add_slow(cloth_.grid_.s_m[j], z_m, shifts[j]);
}

}  // namespace heel::sim
