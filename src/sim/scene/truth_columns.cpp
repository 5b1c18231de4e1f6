#include "sim/scene/truth_columns.h"

#include <array>
#include <cmath>

namespace heel::sim {
namespace {

/// Heading of the camera's optical axis in the world.
double camera_heading_rad(const Truth& truth) {
  const Eigen::Vector3d axis = truth.world_from_camera.linear().col(2);
  return std::atan2(axis.y(), axis.x());
}

constexpr std::array<TruthColumn, 25> kColumns{{
    {"person_x_m", 5, [](const Truth& t) { return t.person.x_m; }},
    {"person_y_m", 5, [](const Truth& t) { return t.person.y_m; }},
    {"person_heading_rad", 6, [](const Truth& t) { return t.person.heading_rad; }},
    {"person_speed_m_s", 4, [](const Truth& t) { return t.person.speed_m_s; }},
    {"back_x_m", 5, [](const Truth& t) { return t.back_m.x(); }},
    {"back_y_m", 5, [](const Truth& t) { return t.back_m.y(); }},
    {"back_z_m", 5, [](const Truth& t) { return t.back_m.z(); }},
    {"back_yaw_rad", 6, [](const Truth& t) { return t.back_yaw_rad; }},
    {"camera_x_m", 5, [](const Truth& t) { return t.world_from_camera.translation().x(); }},
    {"camera_y_m", 5, [](const Truth& t) { return t.world_from_camera.translation().y(); }},
    {"camera_z_m", 5, [](const Truth& t) { return t.world_from_camera.translation().z(); }},
    {"camera_heading_rad", 6, camera_heading_rad},
    {"target_x_m", 5, [](const Truth& t) { return t.back_in_camera_m.x(); }},
    {"target_y_m", 5, [](const Truth& t) { return t.back_in_camera_m.y(); }},
    {"target_z_m", 5, [](const Truth& t) { return t.back_in_camera_m.z(); }},
    {"target_yaw_rad", 6, [](const Truth& t) { return t.yaw_rad; }},
    {"target_x_px", 2, [](const Truth& t) { return t.back_px.x(); }},
    {"target_y_px", 2, [](const Truth& t) { return t.back_px.y(); }},
    {"target_in_view", 0, [](const Truth& t) { return t.in_view ? 1.0 : 0.0; }},
    {"target_occluded", 0, [](const Truth& t) { return t.occluded ? 1.0 : 0.0; }},
    {"robot_pitch_rad", 6, [](const Truth& t) { return t.ground_pose.pitch_rad; }},
    {"robot_roll_rad", 6, [](const Truth& t) { return t.ground_pose.roll_rad; }},
    {"room_light", 3, [](const Truth& t) { return t.exposure.light; }},
    {"exposure_ms", 3, [](const Truth& t) { return t.exposure.exposure_ms; }},
    {"sensor_gain", 3, [](const Truth& t) { return t.exposure.gain; }},
}};

}  // namespace

std::span<const TruthColumn> world_truth_columns() {
  return kColumns;
}

}  // namespace heel::sim
