// The choice of one solution of eight, as in the paper (PRASA 2010): both cameras on the same side of the
// plane (four remain), points in front of both cameras (two), normal nearest to the known one (one).
#include <Eigen/Geometry>

#include "heel/motion.h"

namespace heel {
namespace {

/// Whether most of the points lie in front of both cameras. The points in front for a solution (t, n) are
/// exactly those behind for (−t, −n), so two of four solutions remain. Most, not all: near pure rotation
/// noise may turn a normal to any direction, and the horizon of that plane may cross the region.
bool in_front(const PlaneMotion& motion, std::span<const Eigen::Vector2d> ref_normalised) {
  std::size_t visible = 0;
  for (const Eigen::Vector2d& point : ref_normalised) {
    const Eigen::Vector3d ray = point.homogeneous();
    const double inverse_depth = motion.normal_ref.dot(ray);  // d / Z in the reference camera
    if (inverse_depth <= 0.0) continue;
    const double depth_cur = motion.R_cur_from_ref.row(2).dot(ray) / inverse_depth + motion.t_over_d.z();
    if (depth_cur > 0.0) ++visible;
  }
  return 2 * visible > ref_normalised.size();
}

}  // namespace

MotionChoice choose_motion(const PlaneMotions& motions, std::span<const Eigen::Vector2d> ref_normalised,
                           const Eigen::Vector3d& known_normal_ref) {
  MotionChoice choice;
  double best_agreement = -2.0, second_agreement = -2.0;
  for (int i = 0; i < motions.count; ++i) {
    PlaneMotion motion = motions.motions[static_cast<std::size_t>(i)];
    if (motions.kind == PlaneMotionCase::PureRotation) motion.normal_ref = known_normal_ref;
    if (!motion.same_side || !in_front(motion, ref_normalised)) continue;
    const double agreement = motion.normal_ref.dot(known_normal_ref);
    if (agreement > best_agreement) {
      choice.second = choice.best;
      second_agreement = best_agreement;
      choice.best = i;
      best_agreement = agreement;
    } else if (agreement > second_agreement) {
      choice.second = i;
      second_agreement = agreement;
    }
  }
  return choice;
}

}  // namespace heel
