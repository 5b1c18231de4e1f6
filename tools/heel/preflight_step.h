// One step of `heel preflight`: what was measured, and whether it is good enough to drive with.
#pragma once

#include <atomic>
#include <functional>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "core/config.h"
#include "heel/flow.h"

namespace heel::cli {

enum class StepVerdict { Pass, Fail, Skipped };

struct PreflightStep {
  std::string name;
  StepVerdict verdict = StepVerdict::Skipped;
  std::string measured{};           ///< one line
  std::string advice{};             ///< one line, of a step that failed
  nlohmann::ordered_json values{};  ///< the same numbers, for programs

  PreflightStep& pass(std::string what) {
    verdict = StepVerdict::Pass;
    measured = std::move(what);
    return *this;
  }
  PreflightStep& fail(std::string what, std::string what_to_do) {
    verdict = StepVerdict::Fail;
    measured = std::move(what);
    advice = std::move(what_to_do);
    return *this;
  }
};

/// One or two lines for people.
std::string text_of(const PreflightStep& step);
/// The keys `step`, `verdict`, `measured`, `advice` of a step that failed, and `values`.
nlohmann::ordered_json json_of(const PreflightStep& step);

/// What to do about `problem`, which may say itself that another program has the device.
inline std::string advice_on(const std::string& problem, const char* otherwise) {
  const bool in_use = problem.find("in use by") != std::string::npos;
  const bool not_allowed = problem.find("Permission denied") != std::string::npos;
  return in_use        ? "end that program; heeld: systemctl stop heeld"
         : not_allowed ? "do what it says, or ask as root"
                       : otherwise;
}

/// Set by SIGINT, SIGTERM and SIGHUP: the robot is stopped and nothing more is begun.
inline std::atomic<bool> g_preflight_interrupted{false};
/// From now on these signals set it, and do not end the program.
void note_interrupts();

// The steps, in the order in which each needs those before it. None throws for what it judges; what it needs
// and cannot have (a file, a device that another program holds) is a failed step.

/// Opens the camera and looks for three seconds: rate, damage, faults of the picture.
PreflightStep check_camera(const Config& config);
/// The same; `use` gets each frame.
PreflightStep check_camera_and_use(const Config& config, const std::function<void(const FrameView&)>& use);
/// The camera's calibration: it exists, and is of pictures of this size.
PreflightStep check_calibration(const Config& config);
/// The template is usable.
PreflightStep check_shirt(const Config& config);
/// The shirt is found in the camera's pictures as they are mounted; else the mounting in which it is.
PreflightStep check_person(const Config& config);
/// The robot answers, is one that heel knows, its battery is charged, its sonars are heard. It stands still.
PreflightStep check_robot(const Config& config);
/// Drives the wheels forwards and to the left, each for a second, slowly, and compares odometry. For a robot
/// on blocks.
PreflightStep check_wheels(const Config& config);

struct NamedStep {
  const char* name;
  PreflightStep (*check)(const Config& config);
  const char* measures;
};
/// In their order.
std::span<const NamedStep> preflight_steps();

}  // namespace heel::cli
