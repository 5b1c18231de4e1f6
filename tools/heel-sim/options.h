// The command line of heel-sim.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/robot/chassis.h"

namespace heel::sim {

struct Options {
  std::string robot;  ///< empty: no robot, only files are written
  std::string model;  ///< empty: the scenario's, or p3at-sh
  int boot_baud = 9600;
  std::string after_close = "fall-back";
  double track_m = ChassisSettings{}.true_track_m;
  bool exact = false;
  std::vector<std::string> faults;
  bool live_faults = false;
  std::uint64_t seed = 1;
  std::string truth_file;
  double truth_rate_hz = 50.0;
  std::string wire_file;
  double duration_s = 0.0;  ///< 0: until a signal
  std::string scenario_file;
  std::string camera = "none";
  std::string saved_frames_folder;
  std::string reference_picture;
  double reference_distance_m = 1.5;
  std::string camera_info_file;
};

void add_options(CLI::App& app, Options& options);
/// Throws heel::Error naming an option that is missing.
void check_options(const Options& options);

}  // namespace heel::sim
