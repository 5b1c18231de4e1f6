// The folds of a shirt: a random field over the cloth, made of waves. Along the normal it is some millimetres
// high and correlated over some centimetres; along the surface it is smaller and smoother. How the cloth has
// settled determines the phases of all waves; while the person walks, the phases move with the stride.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace heel::sim {

/// The state of the shirt at one moment.
struct ClothState {
  std::uint64_t settling = 0;   ///< each number is another way in which the cloth has settled
  double fold_m = 0.0;          ///< standard deviation of the folds along the normal
  double drag_m = 0.0;          ///< standard deviation of the displacement along the surface, each way
  double pull_m = 0.0;          ///< the same of slow displacements of the whole back, at its corners
  double stride_rad = 0.0;      ///< phase of the gait
  double twist_rad = 0.0;       ///< how far the hem is turned against the shoulders, to the person's left
  double breath_m = 0.0;        ///< how far the ribs are moved outwards
  double slide_around_m = 0.0;  ///< how far the cloth has slid on the body, towards the person's right
  double slide_up_m = 0.0;
};

/// How far a point of the cloth is from its place at rest.
struct ClothShift {
  float normal_m = 0.f, around_m = 0.f, up_m = 0.f;  ///< outwards, to the person's right, upwards
  float slope_around = 0.f, slope_up = 0.f;          ///< of normal_m
};

/// A grid over the cloth: `s_m` are the places of its columns, from the middle of the back towards the
/// person's right; `z_m` those of its rows, above the hips.
struct ClothGrid {
  std::vector<double> s_m, z_m;
};

class Cloth {
 public:
  Cloth(std::uint64_t seed, const ClothGrid& grid);
  const ClothGrid& grid() const { return grid_; }

  /// The displacements in one state.
  class Shifts;

 private:
  static constexpr std::size_t kFolds = 24;
  static constexpr std::size_t kDrags = 6;  ///< around, and as many up
  static constexpr std::size_t kWaves = kFolds + 2 * kDrags;
  /// cos(ks s + kz z + phase); when the gait's phase moves by φ, that of the wave moves by rate · φ.
  struct Wave {
    double ks = 0.0, kz = 0.0, rate = 0.0;
  };

  std::uint64_t seed_;
  ClothGrid grid_;
  std::array<Wave, kWaves> waves_;
  std::vector<float> cos_, sin_;  ///< of ks · s: for each wave a value for each column
};

class Cloth::Shifts {
 public:
  Shifts(const Cloth& cloth, const ClothState& state);

  /// At any place of the cloth.
  ClothShift at(double s_m, double z_m) const;
  /// At all columns of a row of the grid.
  void row(std::size_t index, std::vector<ClothShift>& shifts) const;

 private:
  void add_slow(double s_m, double z_m, ClothShift& shift) const;

  const Cloth& cloth_;
  float fold_amplitude_m_, drag_amplitude_m_;
  std::array<double, kWaves> phase_{};
  // At the corners of the back: along the surface, and along the normal.
  double keystone_m_ = 0.0, stretch_m_ = 0.0;
  double twist_m_ = 0.0, hollow_m_ = 0.0;
};

}  // namespace heel::sim
