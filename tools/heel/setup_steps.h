// The steps of `heel setup`. Each asks, measures by a step of `heel preflight`, and writes what it has found
// into the configuration file: each can be done again alone.
#pragma once

#include <string>
#include <vector>

#include "board_options.h"
#include "preflight_step.h"
#include "setup_dialogue.h"
#include "setup_file.h"
#include "turn_options.h"

namespace heel::cli {

/// What the command line says of each question; empty or 0: the person is asked.
struct SetupOptions {
  std::string config_file;
  std::vector<std::string> steps;
  bool usual_answers = false;
  bool json = false;

  std::string camera;
  TurnOptions turn;
  std::string camera_info;
  BoardOptions board;
  std::string robot;
  bool wheels_on_blocks = false;
  std::vector<std::string> roi;
  double distance_m = 0.0, height_m = 0.0;
  bool drive_back = false;
  double countdown_s = 5.0, reach_time_s = 8.0;

  /// The step was asked for by its name: what there is of it is not kept.
  bool again(const std::string& step) const;
};

struct Setup {
  const SetupOptions& options;
  SetupFile& file;
  Dialogue& dialogue;
  bool drive_back_consented = options.drive_back;  ///< to one drive: each further one is asked for
};

/// The metres that the person has typed; 0 when they are none from `least` to `most`.
double metres_in(const std::string& answer, double least, double most);

/// Camera chosen, its picture measured and upright: camera.source, its size, rate and turn.
PreflightStep set_up_camera(Setup& setup);
/// Calibrated from live pictures of a board, or by a file that there is: camera.info.
PreflightStep set_up_calibration(Setup& setup);
/// Robot found: robot.address.
PreflightStep set_up_robot(Setup& setup);
/// With consent: the wheels turn the right way.
PreflightStep set_up_wheels(Setup& setup);
/// The shirt taught from the sharpest of many pictures: target.shirt.
PreflightStep set_up_shirt(Setup& setup);
/// All steps of preflight that move nothing.
PreflightStep set_up_check(Setup& setup);

}  // namespace heel::cli
