#include "evaluation/reports/still_samples.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/angles.h"
#include "evaluation/metrics/metrics.h"
#include "files/csv_file.h"
#include "files/csv_table.h"

namespace heel::evaluation {
namespace {

constexpr double kWrongYaw_rad = 15.0 * M_PI / 180.0;
constexpr double kWrongShare = 0.1;
constexpr double kWrongLeast_m = 0.15;

}  // namespace

bool is_wrong(double yaw_error_rad, double off_m, double distance_m) {
  return std::abs(yaw_error_rad) > kWrongYaw_rad || off_m > std::max(kWrongLeast_m, kWrongShare * distance_m);
}

double StillSample::yaw_error_rad() const {
  return wrap_angle_rad(yaw_est_rad - true_yaw_rad);
}

double StillSample::aspect_rad() const {
  return wrap_angle_rad(true_yaw_rad - std::atan2(true_x_m, true_z_m));
}

bool StillSample::flipped() const {
  if (!found || std::abs(aspect_rad()) < kLeastFlipAspect_rad) return false;
  return wrap_angle_rad(yaw_est_rad - std::atan2(x_est_m, z_est_m)) * aspect_rad() < 0.0;
}

bool StillSample::wrong() const {
  return found && is_wrong(yaw_error_rad(), std::hypot(x_est_m - true_x_m, z_est_m - true_z_m), true_z_m);
}

std::vector<StillSample> read_stills(const std::string& path) {
  const CsvTable table(path);
  std::vector<StillSample> samples;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const auto number = [&](const char* column) { return table.number(i, column); };
    StillSample s;
    s.name = table.text(i, "name");
    s.shirt = table.text(i, "shirt");
    s.seed = static_cast<std::uint64_t>(number("seed"));
    s.light = number("light");
    s.x_m = number("x_m");
    s.z_m = number("z_m");
    s.yaw_rad = number("yaw_rad");
    s.blur_px = number("blur_px");
    s.occluded = number("occluded");
    s.true_x_m = number("true_x_m");
    s.true_z_m = number("true_z_m");
    s.true_yaw_rad = number("true_yaw_rad");
    s.true_t_x_m = number("true_t_x_m");
    s.true_t_z_m = number("true_t_z_m");
    s.whole_frame_search = number("picture") == 0.0;
    s.found = number("found") != 0.0;
    s.certainty = s.found ? number("certainty") : 0.0;
    s.yaw_est_rad = number("est_yaw_rad");
    s.yaw_sigma_rad = number("est_yaw_sigma_rad");
    s.x_est_m = number("est_x_m");
    s.z_est_m = number("est_z_m");
    s.t_x_m = number("est_t_x_m");
    s.t_x_sigma_m = number("est_t_x_sigma_m");
    s.t_z_m = number("est_t_z_m");
    s.t_z_sigma_m = number("est_t_z_sigma_m");
    s.vision_ms = number("vision_ms");
    samples.push_back(s);
  }
  return samples;
}

std::vector<Step> steps_of(const std::vector<StillSample>& samples, Member at, Member estimate, Member truth,
                           double scale) {
  std::map<double, std::vector<const StillSample*>> groups;
  for (const StillSample& sample : samples) groups[sample.*at].push_back(&sample);
  std::vector<Step> steps;
  for (const auto& [value, members] : groups) {
    Step step;
    step.at = scale * value;
    step.pictures = members.size();
    std::vector<double> estimates, errors, certainties;
    for (const StillSample* sample : members) {
      step.truth += scale * sample->*truth / static_cast<double>(members.size());
      certainties.push_back(sample->certainty);
      if (!sample->found) continue;
      estimates.push_back(scale * sample->*estimate);
      errors.push_back(std::abs(scale * (sample->*estimate - sample->*truth)));
    }
    step.found = estimates.size();
    const Quantiles q = quantiles(estimates), c = quantiles(certainties);
    step.mean = q.mean;
    step.deviation = q.deviation;
    step.mean_abs_error = quantiles(errors).mean;
    step.certainty_mean = c.mean;
    step.certainty_low = c.p05;
    step.certainty_high = c.p95;
    steps.push_back(step);
  }
  return steps;
}

void write_steps(const std::vector<Step>& steps, const std::string& unit, const std::string& path) {
  CsvFile file(path, "commanded,pictures,found,true_" + unit + ",mean_" + unit + ",deviation_" + unit +
                         ",mean_abs_error_" + unit + ",certainty_mean,certainty_p05,certainty_p95");
  for (const Step& s : steps) {
    file.number(s.at, 4).count(s.pictures).count(s.found);
    for (const double value : {s.truth, s.mean, s.deviation, s.mean_abs_error, s.certainty_mean,
                               s.certainty_low, s.certainty_high})
      file.number(value, 4);
    file.end_row();
  }
  file.flush();
}

}  // namespace heel::evaluation
