// The paper's controller: velocities in proportion to the errors of t_z, t_x and yaw (M. Burke, W. Brink,
// "Estimating Target Orientation with a Single Camera for Use in a Human-Following Robot", PRASA 2010,
// section IV), written in the robot frame. With the goal (g_x, g_y) where the reference view is recreated,
// and psi the heading to have there (counter-clockwise +), the image's errors are t_z = g_x, t_x = −g_y, yaw
// = −psi, and
//
//   v     = k_z g_x
//   omega = −k_x t_x − k_yaw yaw = k_x g_y + k_yaw psi
//
// k_yaw = k_x d is bearing-only following: omega = k_x (g_y + d psi) turns towards the person, ignores which
// way they face, and cuts every bend. What walks round a bend in the person's own steps follows from the
// bend: with the robot D behind on the same arc of radius R, psi = D/R and g_y = (D/R)(D/2 − d), and omega
// must be V/R:
//
//   k_yaw = V/D + k_x (d − D/2)
//
// whatever R is. The default is that value for k_x = 1, a template taken at 1.5 m and a brisk 0.5 m/s
// (robot's centre to back: d = 1.65 m, and with the lag V / k_z, D = 2.2 m).
//
// Stability, linearised about a person walking straight at V, the robot on their line at heading error theta
// and offset e (left +). In steady state v = V, so the goal is G = V / k_z ahead, and
//
//   g_y = −e − G theta,  psi = −theta:     e' = V theta,   theta' = −k_x e − (k_yaw + k_x G) theta
//   s² + (k_yaw + k_x V / k_z) s + k_x V = 0
//
// Both coefficients are positive for positive gains and V > 0: stable, with natural frequency sqrt(k_x V) and
// damping (k_yaw + k_x V / k_z) / (2 sqrt(k_x V)), 0.9 or more for the default gains at any speed. A delay T
// in the loop costs the phase (k_yaw + k_x V / k_z) T at the crossing: keep it below 1 rad, i.e. T < 0.7 s by
// default at 0.5 m/s. At V = 0 the offset cannot be driven out by a unicycle; the heading settles where k_x
// g_y = −k_yaw psi.
//
// On top of it, two bounds the gains cannot break:
// · bearing: the person stays in the picture. With beta the person's bearing from the camera and D the range,
//   beta' = −omega + v sin(beta) / D; a control barrier asks |beta| to approach its limit no faster than
//   gain · (distance to the limit), which bounds omega on either side (A. Ames et al., "Control Barrier
//   Functions: Theory and Applications", ECC 2019, Eq. (17)).
// · no reverse unless allowed.
#pragma once

#include "core/config.h"
#include "estimate/target_measurement.h"
#include "heel/flow.h"

namespace heel {

/// The wanted velocity; expiry is set from `lifetime_s`. Zero when the target is not known.
VelocityCommand follow(const TargetState& target, const ControlConfig& control, const CameraMount& mount,
                       TimeNs now_ns, double lifetime_s);

}  // namespace heel
