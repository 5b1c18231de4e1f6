// Settings of the simulated robot. The defaults are those of a p3at-sh as delivered, on an ordinary floor.
#pragma once

#include <string>
#include <vector>

#include "core/pose2.h"
#include "core/robot_model.h"
#include "heel/time.h"
#include "sim/robot/axis_profile.h"
#include "sim/robot/chassis.h"
#include "sim/robot/fault.h"

namespace heel::sim {

struct P3AtSettings {
  P3AtSettings();

  // Identity.
  std::string name = "heel-sim";
  std::string type = "Pioneer";
  std::string subtype = "p3at-sh";
  std::string serial_number = "SIM-0001";
  std::string firmware_version = "3.0";

  // Wire.
  RobotModel model;                ///< units, outline, sonar places
  bool heading_from_zero = false;  ///< THPOS 0…4095 instead of −2048…2047
  bool sends_config = true;        ///< answers CONFIG
  bool sends_fault_flags = true;   ///< the last SIP field of newer firmware
  int boot_baud = 9600;
  bool keeps_rate_after_close = false;  ///< otherwise CLOSE sets the port back to boot_baud
  int autobaud = 2;                     ///< CONFIGpac Autobaud; 0: HOSTBAUD is ignored
  bool junk_before_first_echo = true;   ///< sends "WMS2\r" before its first echo

  // Times.
  TimeNs sip_cycle_ns = 100 * kNsPerMs;
  TimeNs watchdog_ns = 2000 * kNsPerMs;  ///< 0: none
  TimeNs sonar_cycle_ns = 40 * kNsPerMs;
  TimeNs stall_cut_ns = 200 * kNsPerMs;  ///< StallCount

  // Motion. `top` limits all commands; `boot` holds until SETV, SETA, SETRV and SETRA change it.
  AxisLimits translation_top{.speed = 1.2, .acceleration = 2.0, .deceleration = 2.0};
  AxisLimits translation_boot{.speed = 0.75, .acceleration = 0.3, .deceleration = 0.3};
  AxisLimits rotation_top_deg{.speed = 300.0, .acceleration = 600.0, .deceleration = 600.0};
  AxisLimits rotation_boot_deg{.speed = 100.0, .acceleration = 100.0, .deceleration = 100.0};
  int bump_stall = 3;  ///< BUMPSTALL: bit 0 front, bit 1 rear
  ChassisSettings chassis;
  int ticks_per_mm = 138;

  // Power.
  double battery_v = 12.8;
  double battery_drain_v_per_h = 0.5;
  int charge_state = 0;

  Pose2 start;  ///< in the world
  std::vector<Fault> faults;
};

/// Those of another robot of the family. The older ones, whose subclass does not end in "-sh", count headings
/// from zero and send a shorter SIP. Throws heel::Error when there is no such robot.
P3AtSettings settings_of_model(const std::string& subclass);
/// The same for settings that say more about this robot and its floor.
void use_model(const std::string& subclass, P3AtSettings& settings);

}  // namespace heel::sim
