#include <array>
#include <cstdint>

#include "evaluation/benchmarks/vision_report.h"

namespace heel::evaluation {
namespace {

using Json = nlohmann::ordered_json;

// In the order of VisionStage.
constexpr std::array<StageName, kVisionStages> kStageNames{{
    {"integral", "integral image"},
    {"hessian", "fast-Hessian"},
    {"selection", "selection"},
    {"description", "description"},
    {"matching", "matching"},
    {"undistortion", "undistortion"},
    {"homography", "homography"},
    {"guided_matching", "guided matching"},
    {"motion", "motion"},
}};

Json number(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

/// Times and ratio; without a single frame all of them are null.
Json times_json(const VisionBench& bench, const Times& times, const std::string& yardstick) {
  const auto ms = [&](double value) { return times.count > 0 ? Json(value) : Json(nullptr); };
  Json json{{"min_ms", ms(times.min_ms)}, {"median_ms", ms(times.median_ms)}, {"p99_ms", ms(times.p99_ms)}};
  if (yardstick.empty()) return json;
  json["ratio"] = number(bench.ratio(times, yardstick));
  json["yardstick"] = yardstick;
  return json;
}

Json figure_json(const VisionReport& report, const Figure& figure) {
  const VisionBench& bench = report.bench;
  Json json = times_json(bench, figure.times, figure.yardstick);
  if (!figure.yardstick.empty()) {
    const std::optional<double> ratio = bench.ratio(figure);
    json["goal"] = number(figure.goal);
    json["reached"] = figure.goal && ratio ? Json(*ratio <= *figure.goal) : Json(nullptr);
  }
  json["frames"] = figure.times.count;
  if (figure.features) json["features"] = *figure.features;
  if (figure.corner_error_px) json["corner_error_px"] = *figure.corner_error_px;
  if (figure.found_share) json["found_share"] = *figure.found_share;
  if (figure.stages.empty()) return json;
  json["ns_per_px"] = 1e6 * figure.times.median_ms / figure.pixels.value_or(report.size.area());
  json["stage_share"] = figure.stage_share;
  for (const StageFigure& stage : figure.stages) {
    Json entry = times_json(bench, stage.times, figure.yardstick);
    entry["goal"] = nullptr;
    json["stages"][name_of(stage.stage).key] = entry;
  }
  return json;
}

Json cost_models_json(const VisionBench& bench) {
  Json json = Json::object();
  for (const CostModel& model : bench.cost_models)
    json[model.key] = {{"measured_ms", model.measured_ms},
                       {"model_low_ms", model.low_ms},
                       {"model_high_ms", model.high_ms},
                       {"ratio", model.ratio()}};
  return json;
}

}  // namespace

const StageName& name_of(VisionStage stage) {
  return kStageNames[static_cast<std::size_t>(stage)];
}

nlohmann::ordered_json to_json(const VisionReport& report) {
  const VisionBench& bench = report.bench;
  Json json;
  json["machine"] = json_of(report.machine);
  json["machine"]["cpu_share"] = bench.cpu_share;
  json["settings"] = {{"source", report.source},
                      {"width_px", report.size.width},
                      {"height_px", report.size.height},
                      {"frames", report.frames},
                      {"template_features", bench.template_features},
                      {"clock", "thread CPU time"}};
  json["found_share"] = bench.found_share;
  json["tracked_share"] = bench.tracked_share;
  for (const Figure& figure : bench.figures) json["figures"][figure.key] = figure_json(report, figure);
  for (const Figure& figure : bench.yardsticks) json["yardsticks"][figure.key] = figure_json(report, figure);
  json["machine_scale"] = bench.machine_scale;
  json["cost_models"] = cost_models_json(bench);
  return json;
}

}  // namespace heel::evaluation
