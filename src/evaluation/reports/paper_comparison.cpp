#include "evaluation/reports/paper_comparison.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>

#include "core/angles.h"
#include "evaluation/reports/error_statistics.h"

namespace heel::evaluation {
namespace {

constexpr double kPaperReliable = 0.1, kPaperRarely = 0.6;
constexpr double kTrustedShare = 0.95;  ///< of the pictures at an angle: found, with certainty above 0.1
constexpr double kGoalYaw_deg = 2.0, kGoalFlips = 0.001, kGoalRSquared = 0.999, kGoalFollow_m = 0.15;
constexpr double kGoalNear_m = 1.0, kGoalFar_m = 4.0, kGoalYawRange_rad = 60.0 / kDegPerRad;
constexpr double kMonotoneFar_m = 5.0;

[[gnu::format(printf, 1, 2)]] std::string printed(const char* format, ...) {
  char text[400];
  va_list values;
  va_start(values, format);
  std::vsnprintf(text, sizeof text, format, values);
  va_end(values);
  return text;
}

double percent(std::size_t part, std::size_t whole) {
  return whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

/// Commanded values come through radians.
double rounded(double value) {
  return std::round(100.0 * value) / 100.0;
}

std::string paper_row(const char* what, const char* paper, const std::string& ours) {
  return std::string("| ") + what + " | " + paper + " | " + ours + " |\n";
}

std::string certainty_above(const std::vector<StillSample>& stills) {
  std::size_t found = 0, above = 0;
  double highest = 0.0;
  for (const StillSample& s : stills) {
    if (!s.found) continue;
    ++found;
    if (s.certainty > kPaperRarely) ++above;
    highest = std::max(highest, s.certainty);
  }
  return printed("above 0.6 in %.1f %% of %zu detections, at most %.2f", percent(above, found), found,
                 highest);
}

/// How often an estimate is wrong on either side of the paper's threshold.
std::string certainty_reliable(const std::vector<StillSample>& stills) {
  std::size_t above = 0, wrong_above = 0, below = 0, wrong_below = 0;
  for (const StillSample& s : stills) {
    if (!s.found) continue;
    (s.certainty > kPaperReliable ? above : below) += 1;
    if (s.wrong()) (s.certainty > kPaperReliable ? wrong_above : wrong_below) += 1;
  }
  return printed("wrong above 0.1: %.1f %% of %zu; below: %.1f %% of %zu", percent(wrong_above, above), above,
                 percent(wrong_below, below), below);
}

/// The widest angle up to which the shirt is found with certainty above 0.1.
std::string trust_lost(const std::vector<StillSample>& yaw) {
  double trusted_deg = 0.0, seen_deg = 0.0;
  for (const Step& step : steps_of(yaw, &StillSample::yaw_rad, &StillSample::yaw_est_rad,
                                   &StillSample::true_yaw_rad, kDegPerRad)) {
    std::size_t trusted = 0;
    for (const StillSample& s : yaw)
      if (kDegPerRad * s.yaw_rad == step.at && s.found && s.certainty > kPaperReliable) ++trusted;
    if (percent(trusted, step.pictures) >= 100.0 * kTrustedShare)
      trusted_deg = std::max(trusted_deg, std::abs(step.at));
    if (step.found > 0) seen_deg = std::max(seen_deg, std::abs(step.at));
  }
  return printed("certainty above 0.1 in %.0f %% of pictures up to %.0f degrees; last found at all at %.0f",
                 100.0 * kTrustedShare, trusted_deg, seen_deg);
}

std::string spread_over_distance(const std::vector<StillSample>& distance) {
  std::string text = "deviation of t_z";
  for (const Step& s : steps_of(distance, &StillSample::z_m, &StillSample::z_est_m, &StillSample::true_z_m))
    if (s.found > 1 && std::abs(s.at - std::round(s.at)) < 1e-9)
      text += printed(", %.0f mm at %.0f m", 1e3 * s.deviation, s.at);
  return text;
}

std::string monotone(const ExperimentData& data) {
  const auto lateral =
      steps_of(data.lateral, &StillSample::x_m, &StillSample::x_est_m, &StillSample::true_x_m);
  const auto distance =
      steps_of(data.distance, &StillSample::z_m, &StillSample::z_est_m, &StillSample::true_z_m);
  const auto yaw = steps_of(data.yaw, &StillSample::yaw_rad, &StillSample::yaw_est_rad,
                            &StillSample::true_yaw_rad, kDegPerRad);
  const auto said = [](const char* name, const std::string& breaks) {
    return std::string(name) + ": " + (breaks.empty() ? "yes" : breaks);
  };
  return said("t_x", breaks_of_monotony(lateral, "m")) + "; " +
         said("t_z", breaks_of_monotony(distance, "m")) + "; " +
         said("yaw", breaks_of_monotony(yaw, "degrees"));
}

std::string markdown_goal_row(const char* what, const char* goal, const std::string& measured, bool met) {
  return std::string("| ") + what + " | " + goal + " | " + measured + " | " + (met ? "yes" : "**no**") +
         " |\n";
}

std::string yaw_goals(const ExperimentData& data) {
  std::string rows;
  // The yaw experiment stands at 2 m; the errors' undisturbed poses fill the range.
  std::vector<StillSample> undisturbed;
  for (const StillSample& s : data.errors)
    if (s.undisturbed()) undisturbed.push_back(s);
  if (undisturbed.empty()) return rows;
  const auto within = [](double yaw_rad) {
    return [yaw_rad](const StillSample& s) {
      return s.true_z_m >= kGoalNear_m && s.true_z_m <= kGoalFar_m && std::abs(s.true_yaw_rad) <= yaw_rad;
    };
  };
  const ErrorBin all = error_bin("", 0.0, undisturbed, within(kGoalYawRange_rad));
  const ErrorBin ahead = error_bin("", 0.0, undisturbed, within(20.0 / kDegPerRad));
  rows += markdown_goal_row("mean absolute yaw error, 1 to 4 m, up to 60 degrees", "at most 2 degrees",
                            printed("%.2f degrees (up to 20 degrees: %.2f)",
                                    kDegPerRad * all.yaw_mean_abs_rad, kDegPerRad * ahead.yaw_mean_abs_rad),
                            kDegPerRad * all.yaw_mean_abs_rad <= kGoalYaw_deg);
  rows += markdown_goal_row("sign flips of a back turned by 10 degrees or more", "below 0.1 %",
                            printed("%zu of %zu (%.2f %%)", all.flips, all.signed_pictures,
                                    percent(all.flips, all.signed_pictures)),
                            percent(all.flips, all.signed_pictures) < 100.0 * kGoalFlips);
  const NeesBand band = nees_band(all.found);
  rows += markdown_goal_row("stated deviation of yaw: mean of (error / sigma) squared",
                            printed("%.2f ... %.2f", band.low, band.high).c_str(),
                            printed("%.1f (up to 20 degrees: %.1f)", all.yaw_nees, ahead.yaw_nees),
                            all.yaw_nees >= band.low && all.yaw_nees <= band.high);
  return rows;
}

}  // namespace

std::vector<StillSample> ExperimentData::all_stills() const {
  std::vector<StillSample> all;
  for (const auto* part : {&lateral, &distance, &yaw, &errors})
    all.insert(all.end(), part->begin(), part->end());
  return all;
}

double r_squared(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  if (x.size() < 3) return 0.0;
  double sx = 0, sy = 0, sxx = 0, syy = 0, sxy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sx += x[i];
    sy += y[i];
    sxx += x[i] * x[i];
    syy += y[i] * y[i];
    sxy += x[i] * y[i];
  }
  const double covariance = sxy - sx * sy / n;
  return covariance * covariance / ((sxx - sx * sx / n) * (syy - sy * sy / n));
}

std::string breaks_of_monotony(const std::vector<Step>& steps, const std::string& unit) {
  std::string breaks, unseen;
  const Step* before = nullptr;
  for (const Step& step : steps) {
    if (2 * step.found < step.pictures) {
      unseen += printed("%s%g", unseen.empty() ? "" : ", ", rounded(step.at));
      continue;
    }
    if (before != nullptr && step.mean <= before->mean)
      breaks += printed("%sfalls from %g to %g %s", breaks.empty() ? "" : ", ", rounded(before->at),
                        rounded(step.at), unit.c_str());
    before = &step;
  }
  if (breaks.empty() && unseen.empty()) return {};
  if (breaks.empty()) breaks = "yes where found";
  if (!unseen.empty()) breaks += " (found in fewer than half of the pictures at " + unseen + " " + unit + ")";
  return breaks;
}

std::string paper_table(const ExperimentData& data) {
  std::string text = "| what | the paper (PRASA 2010) | ours |\n|---|---|---|\n";
  const auto stills = data.all_stills();
  if (!stills.empty()) {
    text += paper_row("certainty", "rarely above 0.6", certainty_above(stills));
    text += paper_row("certainty above 0.1", "reliable", certainty_reliable(stills));
  }
  if (!data.yaw.empty()) text += paper_row("trust in the yaw", "lost near 60 degrees", trust_lost(data.yaw));
  if (!data.distance.empty())
    text += paper_row("spread", "grows with distance", spread_over_distance(data.distance));
  if (!data.lateral.empty() && !data.distance.empty() && !data.yaw.empty())
    text += paper_row("monotone", "everywhere", monotone(data));
  return text;
}

std::string goals_table(const ExperimentData& data) {
  std::string text = "| what | goal | measured | met |\n|---|---|---|---|\n";
  text += yaw_goals(data);
  if (!data.lateral.empty()) {
    std::vector<double> x, y;
    for (const StillSample& s : data.lateral) {
      if (!s.found) continue;
      x.push_back(s.true_x_m);
      y.push_back(s.x_est_m);
    }
    const double r2 = r_squared(x, y);
    text += markdown_goal_row("t_x against the truth, 2 m away", "R2 at least 0.999", printed("R2 %.5f", r2),
                              r2 >= kGoalRSquared);
  }
  if (!data.distance.empty()) {
    std::vector<StillSample> near;
    for (const StillSample& s : data.distance)
      if (s.z_m <= kMonotoneFar_m + 1e-9) near.push_back(s);
    const std::string breaks = breaks_of_monotony(
        steps_of(near, &StillSample::z_m, &StillSample::z_est_m, &StillSample::true_z_m), "m");
    text += markdown_goal_row("t_z from 1 to 5 m", "monotone", breaks.empty() ? "monotone" : breaks,
                              breaks.empty());
  }
  if (data.walk) {
    const double rms_m = data.walk->metrics.lateral_m.rms;
    std::string measured = printed("%.3f m RMS over %.0f m", rms_m, data.walk->metrics.person_path_m);
    if (data.walk_position_only)
      measured +=
          printed("; following the position only: %.3f m", data.walk_position_only->metrics.lateral_m.rms);
    text += markdown_goal_row("robot's path beside the person's", "within 0.15 m RMS", measured,
                              rms_m <= kGoalFollow_m);
  }
  return text;
}

}  // namespace heel::evaluation
