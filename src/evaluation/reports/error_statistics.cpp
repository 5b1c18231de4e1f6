#include "evaluation/reports/error_statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "core/angles.h"
#include "evaluation/metrics/metrics.h"
#include "files/csv_file.h"

namespace heel::evaluation {
namespace {

constexpr double kNormal95 = 1.959964;
// Where a curve shows one condition, the others stay where the robot follows: near enough and not averted.
constexpr double kEasyZM = 3.0, kEasyAspect_rad = 45.0 / kDegPerRad;

double square(double value) {
  return value * value;
}

std::string range_name(double low, double high, const char* unit) {
  char text[48];
  std::snprintf(text, sizeof text, "%g ... %g %s", low, high, unit);
  return text;
}

/// Bins between the edges of `value`, among the samples that `others` lets through.
ErrorCurve curve_over(const char* condition, const char* unit, const std::vector<double>& edges,
                      const std::vector<StillSample>& samples,
                      const std::function<double(const StillSample&)>& value, const Condition& others) {
  ErrorCurve curve{condition, unit, {}};
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const double low = edges[i], high = edges[i + 1];
    ErrorBin bin =
        error_bin(range_name(low, high, unit), 0.5 * (low + high), samples,
                  [&](const StillSample& s) { return others(s) && value(s) >= low && value(s) < high; });
    if (bin.pictures > 0) curve.bins.push_back(bin);
  }
  return curve;
}

bool easy_pose(const StillSample& s) {
  return s.true_z_m < kEasyZM && std::abs(s.aspect_rad()) < kEasyAspect_rad;
}

}  // namespace

ErrorBin error_bin(const std::string& name, double middle, const std::vector<StillSample>& samples,
                   const Condition& belongs) {
  ErrorBin bin;
  bin.name = name;
  bin.middle = middle;
  std::vector<double> yaw, yaw_abs, x, z;
  double outward = 0.0, yaw_nees = 0.0, t_x_nees = 0.0, t_z_nees = 0.0, certainty = 0.0;
  for (const StillSample& s : samples) {
    if (!belongs(s)) continue;
    ++bin.pictures;
    if (!s.found) continue;
    ++bin.found;
    if (s.wrong()) ++bin.wrong;
    if (std::abs(s.aspect_rad()) >= kLeastFlipAspect_rad) ++bin.signed_pictures;
    if (s.flipped()) ++bin.flips;
    yaw.push_back(s.yaw_error_rad());
    outward += std::copysign(1.0, s.aspect_rad()) * s.yaw_error_rad();
    yaw_abs.push_back(std::abs(s.yaw_error_rad()));
    x.push_back(s.x_est_m - s.true_x_m);
    z.push_back(s.z_est_m - s.true_z_m);
    yaw_nees += square(s.yaw_error_rad() / s.yaw_sigma_rad);
    t_x_nees += square((s.t_x_m - s.true_t_x_m) / s.t_x_sigma_m);
    t_z_nees += square((s.t_z_m - s.true_t_z_m) / s.t_z_sigma_m);
    certainty += s.certainty;
  }
  if (bin.found == 0) return bin;
  const auto count = static_cast<double>(bin.found);
  const Quantiles yaw_q = quantiles(yaw), abs_q = quantiles(yaw_abs);
  const Quantiles x_q = quantiles(x), z_q = quantiles(z);
  bin.yaw_outward_mean_rad = outward / count;
  bin.yaw_mean_rad = yaw_q.mean;
  bin.yaw_deviation_rad = yaw_q.deviation;
  bin.yaw_mean_abs_rad = abs_q.mean;
  bin.yaw_p95_rad = abs_q.p95;
  bin.x_mean_m = x_q.mean;
  bin.x_deviation_m = x_q.deviation;
  bin.z_mean_m = z_q.mean;
  bin.z_deviation_m = z_q.deviation;
  bin.yaw_nees = yaw_nees / count;
  bin.t_x_nees = t_x_nees / count;
  bin.t_z_nees = t_z_nees / count;
  bin.certainty = certainty / count;
  return bin;
}

std::vector<ErrorCurve> error_curves(const std::vector<StillSample>& samples) {
  const auto bold = [](const StillSample& s) { return s.shirt == "bold"; };
  std::vector<ErrorCurve> curves;
  curves.push_back(curve_over(
      "distance", "m", {0.5, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0, 5.6}, samples,
      [](const StillSample& s) { return s.true_z_m; },
      [&](const StillSample& s) {
        return bold(s) && s.undisturbed() && std::abs(s.aspect_rad()) < kEasyAspect_rad;
      }));
  curves.push_back(curve_over(
      "angle to the line of sight", "deg", {0, 10, 20, 30, 40, 50, 60, 70, 80, 105}, samples,
      [](const StillSample& s) { return kDegPerRad * std::abs(s.aspect_rad()); },
      [&](const StillSample& s) { return bold(s) && s.undisturbed() && s.true_z_m < kEasyZM; }));
  curves.push_back(curve_over(
      "blur", "px", {0.0, 0.5, 2, 4, 6, 9.1}, samples, [](const StillSample& s) { return s.blur_px; },
      [&](const StillSample& s) { return bold(s) && easy_pose(s) && s.light == 1.0 && s.occluded == 0.0; }));
  curves.push_back(curve_over(
      "light", "", {0.05, 0.1, 0.2, 0.4, 0.8, 1.1}, samples, [](const StillSample& s) { return s.light; },
      [&](const StillSample& s) {
        return bold(s) && easy_pose(s) && s.blur_px == 0.0 && s.occluded == 0.0;
      }));
  curves.push_back(curve_over(
      "hidden share of the back", "", {0.0, 0.05, 0.2, 0.35, 0.5, 0.71}, samples,
      [](const StillSample& s) { return std::abs(s.occluded); },
      [&](const StillSample& s) { return bold(s) && easy_pose(s) && s.blur_px == 0.0 && s.light == 1.0; }));
  ErrorCurve shirts{"shirt", "", {}};
  for (const char* shirt : {"bold", "mosaic"}) {
    const ErrorBin bin =
        error_bin(shirt, static_cast<double>(shirts.bins.size()), samples,
                  [&](const StillSample& s) { return s.shirt == shirt && s.undisturbed() && easy_pose(s); });
    if (bin.pictures > 0) shirts.bins.push_back(bin);
  }
  curves.push_back(shirts);
  return curves;
}

void write_errors(const std::vector<ErrorCurve>& curves, const std::string& path) {
  CsvFile file(path,
               "condition,unit,middle,bin,pictures,found,wrong,with_sign,flips,certainty,yaw_mean_deg,"
               "yaw_outward_mean_deg,yaw_deviation_deg,yaw_mean_abs_deg,yaw_p95_deg,x_mean_m,x_deviation_m,"
               "z_mean_m,z_deviation_m,yaw_nees,t_x_nees,t_z_nees");
  for (const ErrorCurve& curve : curves)
    for (const ErrorBin& b : curve.bins) {
      file.text(curve.condition).text(curve.unit).number(b.middle, 3).text(b.name);
      file.count(b.pictures).count(b.found).count(b.wrong).count(b.signed_pictures).count(b.flips);
      file.number(b.certainty, 4);
      for (const double yaw_rad :
           {b.yaw_mean_rad, b.yaw_outward_mean_rad, b.yaw_deviation_rad, b.yaw_mean_abs_rad, b.yaw_p95_rad})
        file.number(kDegPerRad * yaw_rad, 3);
      for (const double position_m : {b.x_mean_m, b.x_deviation_m, b.z_mean_m, b.z_deviation_m})
        file.number(position_m, 4);
      for (const double nees : {b.yaw_nees, b.t_x_nees, b.t_z_nees}) file.number(nees, 3);
      file.end_row();
    }
  file.flush();
}

void write_error_map(const std::vector<StillSample>& samples, const std::string& path) {
  constexpr std::array kDistances_m{0.9, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0, 5.6};
  constexpr std::array kAngles_deg{-80.0, -60.0, -45.0, -30.0, -15.0, 0.0, 15.0, 30.0, 45.0, 60.0, 80.0};
  CsvFile file(path,
               "distance_from_m,distance_to_m,angle_from_deg,angle_to_deg,pictures,found,yaw_mean_deg,"
               "yaw_deviation_deg,yaw_mean_abs_deg");
  for (std::size_t r = 0; r + 1 < kDistances_m.size(); ++r)
    for (std::size_t c = 0; c + 1 < kAngles_deg.size(); ++c) {
      const ErrorBin bin = error_bin("", 0.0, samples, [&](const StillSample& s) {
        const double angle_deg = kDegPerRad * s.aspect_rad();
        return s.undisturbed() && s.shirt == "bold" && s.true_z_m >= kDistances_m[r] &&
               s.true_z_m < kDistances_m[r + 1] && angle_deg >= kAngles_deg[c] &&
               angle_deg < kAngles_deg[c + 1];
      });
      file.number(kDistances_m[r], 1).number(kDistances_m[r + 1], 1);
      file.number(kAngles_deg[c], 0).number(kAngles_deg[c + 1], 0).count(bin.pictures).count(bin.found);
      for (const double yaw_rad : {bin.yaw_mean_rad, bin.yaw_deviation_rad, bin.yaw_mean_abs_rad})
        file.number(kDegPerRad * yaw_rad, 3);
      file.end_row();
    }
  file.flush();
}

NeesBand nees_band(std::size_t count) {
  const double n = std::max<double>(1.0, static_cast<double>(count));
  const auto quantile = [&](double z) {
    const double root = 1.0 - 2.0 / (9.0 * n) + z * std::sqrt(2.0 / (9.0 * n));
    return root * root * root;  // of chi² / n
  };
  return {quantile(-kNormal95), quantile(kNormal95)};
}

}  // namespace heel::evaluation
