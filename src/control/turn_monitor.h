// Does the person's bearing shrink when the robot turns towards them? It grows when the picture is upside
// down or mirrored, or when the wheels' or the gyro's connections are swapped: then the robot would turn away
// from the person, faster and faster.
//
// Each sighting is placed into odom twice: as it should be, and with left and right exchanged. People walk
// where their body faces; while the robot turns, only one of the two persons does, and the other one slides
// sideways, with twice the robot's yaw rate times the distance. A person who really steps aside does so in
// both, until the robot turns.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "core/pose2.h"
#include "estimate/constant_velocity_filter.h"
#include "estimate/odometry_history.h"
#include "estimate/target_measurement.h"
#include "heel/flow.h"

namespace heel {

/// Reads no clock, does not allocate.
class TurnMonitor {
 public:
  /// Once a tick. `t_newest_ns`: of the newest packet in `odometry`.
  void update(const OdometryHistory& odometry, TimeNs t_newest_ns);
  /// Each new pose, in order of their frames. One that was not found counts for nothing.
  void add_pose(const PoseEstimate& pose, const CameraMount& mount);
  /// After an interruption, or an operator's reset.
  void reset() { *this = {}; }

  /// Whether exchanged sides have explained the sightings far better. Until a reset.
  bool turns_away() const { return turns_away_; }
  /// How much better now: natural logarithm of the ratio of the likelihoods.
  double evidence() const { return evidence_; }

 private:
  struct Sighting {
    TimeNs t_ns = 0;
    Eigen::Vector2d position_m = Eigen::Vector2d::Zero();  ///< robot frame at t_ns, as the yaw
    double yaw_rad = 0.0;
  };
  /// The person in odom by one of the two explanations.
  struct Person {
    double side = 1.0;  ///< −1: left and right are exchanged
    ConstantVelocityFilter<2> filter;

    void start(const Pose2& robot, const Sighting& sighting);
    /// Returns the speed sideways of the body.
    double update(const Pose2& robot, const Sighting& sighting, double dt_s);
  };
  void explain(const Sighting& sighting, const Pose2& robot);

  // Sightings wait for a packet that is newer: an extrapolated heading is wrong while the yaw rate changes.
  static constexpr std::size_t kWaiting = 32;
  std::array<Sighting, kWaiting> waiting_{};
  std::size_t waiting_count_ = 0;

  Person as_it_should_be_{.side = 1.0, .filter = {}};
  Person exchanged_{.side = -1.0, .filter = {}};
  TimeNs t_start_ns_ = 0;  ///< of both; 0: no sighting yet
  TimeNs t_last_ns_ = 0;
  double evidence_ = 0.0;
  bool turns_away_ = false;
};

}  // namespace heel
