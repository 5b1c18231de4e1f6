#include "preflight_step.h"

#include <fmt/format.h>

#include <csignal>

namespace heel::cli {
namespace {

constexpr NamedStep kSteps[] = {
    {"camera", check_camera, "rate, damaged pictures, light, focus"},
    {"calibration", check_calibration, "the camera's file"},
    {"shirt", check_shirt, "the template"},
    {"person", check_person, "the shirt is found, upright, at its distance; somebody stands there in it"},
    {"robot", check_robot, "answer, model, battery, packets, sonars; it stands still"},
    {"wheels", check_wheels, "they turn the right way; only with --wheels-on-blocks"},
};

const char* word_of(StepVerdict verdict) {
  return verdict == StepVerdict::Pass ? "pass" : verdict == StepVerdict::Fail ? "fail" : "skipped";
}

}  // namespace

std::span<const NamedStep> preflight_steps() {
  return kSteps;
}

std::string text_of(const PreflightStep& step) {
  const char* const word = step.verdict == StepVerdict::Fail ? "FAIL" : word_of(step.verdict);
  std::string text = fmt::format("{:<12} {:<8} {}\n", step.name, word, step.measured);
  if (!step.advice.empty()) text += fmt::format("{:<21} -> {}\n", "", step.advice);
  return text;
}

nlohmann::ordered_json json_of(const PreflightStep& step) {
  nlohmann::ordered_json json{
      {"step", step.name}, {"verdict", word_of(step.verdict)}, {"measured", step.measured}};
  if (step.verdict == StepVerdict::Fail) json["advice"] = step.advice;
  if (!step.values.is_null()) json["values"] = step.values;
  return json;
}

void note_interrupts() {
  for (const int number : {SIGINT, SIGTERM, SIGHUP})
    std::signal(number, [](int) { g_preflight_interrupted = true; });
}

}  // namespace heel::cli
