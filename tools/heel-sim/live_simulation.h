// The robot in real time, and with a scenario the world around it: a walking person, contacts and the camera.
#pragma once

#include <csignal>
#include <memory>
#include <string>

#include "files/sampled_csv.h"
#include "line_input.h"
#include "options.h"
#include "sim/contact/contact.h"
#include "sim/live/live_camera.h"
#include "sim/robot/p3at.h"
#include "sim/scene/world.h"
#include "sim/transport/robot_server.h"
#include "sim/transport/transport.h"
#include "sim/transport/wire_file.h"

namespace heel::sim {

class LiveSimulation {
 public:
  /// `scenario` may be null: a robot without a world. Throws heel::Error when an address or a file cannot be
  /// used.
  LiveSimulation(const Options& options, const Scenario* scenario);

  /// Steps once a millisecond until the duration is over or `stop` is not 0.
  void run(const volatile std::sig_atomic_t& stop);
  void print_camera_counters() const;

 private:
  /// What only a scenario brings.
  struct LiveWorld {
    LiveWorld(const Scenario& scenario, P3At& robot) : world(scenario), contact(world, robot) {}

    World world;
    Contact contact;
    SharedMotion motion;
    Truth truth;  ///< of the CSV row being written
    std::unique_ptr<LiveCamera> camera;
  };

  void open_recordings(const Options& options);
  void add_robot_columns();
  void add_world_columns();
  void write_truth_rows(TimeNs t_ns);
  void step_world(TimeNs t_ns);
  void begin_live_faults(TimeNs t_ns);
  void begin_live_fault(const std::string& line, TimeNs t_ns);
  void print_progress(TimeNs t_ns) const;

  P3At robot_;
  std::unique_ptr<LiveWorld> live_world_;  ///< null without a scenario
  std::unique_ptr<Transport> transport_;
  TimeNs t_start_ns_;
  double duration_s_;
  std::unique_ptr<WireFile> wire_;
  std::unique_ptr<RobotServer> server_;
  std::unique_ptr<SampledCsv> truth_;
  std::unique_ptr<LineInput> live_faults_;  ///< null without --live-faults
  TimeNs truth_period_ns_;
  TimeNs t_next_row_ns_ = 0;
  TimeNs t_next_progress_ns_ = 0;
  TimeNs t_stepped_ns_ = 0;  ///< the world
};

}  // namespace heel::sim
