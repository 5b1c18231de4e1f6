// heeld and heel-sim as processes that follow a simulated person in real time, for measurements: the template
// is taught, the configuration written, and both run until this object ends.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "background_program.h"

namespace heel::cli {

struct WalkOptions {
  std::string pictures = "none";  ///< telemetry.pictures
  std::string more_config{};      ///< sections at the end of the configuration
  bool camera = true;             ///< false: no picture ever comes, and the robot rests
};

class SimulatedWalk {
 public:
  /// Starts both, in a new temporary folder. Throws heel::Error.
  explicit SimulatedWalk(const WalkOptions& options = {});
  ~SimulatedWalk();
  SimulatedWalk(const SimulatedWalk&) = delete;
  SimulatedWalk& operator=(const SimulatedWalk&) = delete;

  /// Ends both; the files stay until this object ends.
  void end();
  /// Waits until the robot is linked, for a walk without a camera. Throws heel::Error.
  void wait_until_linked();
  /// Waits until the robot follows the person, and then so long. Throws heel::Error.
  void wait_until_following(double and_then_s);
  /// The port of heeld's page, of a walk whose configuration serves it. Throws heel::Error.
  std::uint16_t page_port();
  /// True: it follows now. Throws heel::Error when one of the programs has ended.
  bool follows();

  BackgroundProgram& daemon() { return *daemon_; }
  std::string socket() const { return file("control.sock"); }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }

 private:
  void teach() const;
  void write_config(const WalkOptions& options) const;

  std::filesystem::path folder_;
  std::string camera_;
  std::unique_ptr<BackgroundProgram> world_, daemon_;  // the daemon ends first, so that it can stop its robot
};

}  // namespace heel::cli
