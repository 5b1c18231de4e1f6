#include "simulated_walk.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>

#include "evaluation/reports/run_program.h"
#include "files/atomic_file.h"
#include "heel/error.h"
#include "realtime/clock.h"

namespace heel::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kStartTimeout_s = 60.0;
constexpr const char* kTeachDistance_m = "1.5";

// A circle, walked once in a minute: what the robot sees and does stays the same.
constexpr const char* kScenario = R"(name = "circle"
seed = 7
duration_s = 86400.0

[person]
shirt = "bold"
walk_after_s = 1.0
sway_yaw_deg = 2.5
hips_yaw_deg = 9.0
sway_side_m = 0.02

[[person.path]]
step = "arc"
radius_m = 5.0
angle_deg = 350.0
speed_m_s = 0.5

[camera]
rate_hz = 30.0
width_px = 640
height_px = 480

[robot]
x_m = -1.8

[room]
objects = 30
)";

fs::path program(const std::string& name) {
  return fs::read_symlink("/proc/self/exe").parent_path() / name;
}

void run(const std::vector<std::string>& arguments) {
  const evaluation::ProgramEnd end = evaluation::run_program(arguments);
  if (end.start_error == 0 && end.status == 0) return;
  throw Error(fmt::format("{}: ended with status {}: {}", arguments.front(), end.status, end.complaints));
}

}  // namespace

SimulatedWalk::SimulatedWalk(const WalkOptions& options) {
  std::string name = (fs::temp_directory_path() / "heel-bench-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw Error(name + ": cannot make such a folder");
  folder_ = name;
  camera_ = "sim:" + folder_.filename().string();
  write_file_atomically(file("circle.toml"), kScenario);
  world_ = std::make_unique<BackgroundProgram>(
      std::vector<std::string>{program("heel-sim"), "--scenario", file("circle.toml"), "--robot",
                               "pty:" + file("robot"), "--camera", options.camera ? camera_ : "none",
                               "--still", file("shirt.png"), "--distance", kTeachDistance_m,
                               "--camera-info-out", file("camera.yaml")},
      file("heel-sim.log"));
  world_->wait_for("ready at", kStartTimeout_s);
  teach();
  write_config(options);
  daemon_ = std::make_unique<BackgroundProgram>(
      std::vector<std::string>{program("heeld"), "--config", file("heel.toml")}, file("heeld.log"));
}

void SimulatedWalk::end() {
  daemon_.reset();
  world_.reset();
}

SimulatedWalk::~SimulatedWalk() {
  end();
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

void SimulatedWalk::teach() const {
  const std::string output = world_->output();
  const std::size_t at = output.find("roi=");
  if (at == std::string::npos) throw Error("heel-sim: has not printed the region of the template");
  const std::size_t begin = at + 4;
  const std::string region = output.substr(begin, output.find_first_not_of("0123456789,", begin) - begin);
  run({program("heel"), "teach", "--image", file("shirt.png"), "--roi", region, "--distance",
       kTeachDistance_m, "--camera-info", file("camera.yaml"), "-o", file("shirt.heel")});
}

void SimulatedWalk::write_config(const WalkOptions& options) const {
  fs::create_directory(file("recordings"));
  write_file_atomically(file("heel.toml"), fmt::format(R"([camera]
source = "{}"
info = "camera.yaml"
mount_z_m = 1.1
[target]
shirt = "shirt.heel"
[supervisor]
start = "at_once"
[robot]
address = "pty:robot"
[operator]
socket = "control.sock"
[telemetry]
directory = "recordings"
pictures = "{}"
black_box = "black-box"
{})",
                                                       camera_, options.pictures, options.more_config));
}

void SimulatedWalk::wait_until_following(double and_then_s) {
  daemon_->wait_for("following (following: target good)", kStartTimeout_s);
  sleep_until_ns(monotonic_now_ns() + ns_from_seconds(and_then_s));
}

void SimulatedWalk::wait_until_linked() {
  daemon_->wait_for("link to the robot: running", kStartTimeout_s);
}

std::uint16_t SimulatedWalk::page_port() {
  const std::string before = "the page is served at 127.0.0.1:0, port ";
  daemon_->wait_for(before, kStartTimeout_s);
  const std::string log = daemon_->output();
  return static_cast<std::uint16_t>(std::stoi(log.substr(log.find(before) + before.size())));
}

bool SimulatedWalk::follows() {
  world_->require_running();
  daemon_->require_running();
  const std::string log = daemon_->output();
  const std::size_t followed = log.rfind(" following ("), rested = log.rfind("at rest:");
  return followed != std::string::npos && (rested == std::string::npos || rested < followed);
}

}  // namespace heel::cli
