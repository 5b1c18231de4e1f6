#include "evaluation/reports/foreign_figures.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "files/csv_table.h"

namespace heel::evaluation {
namespace {

constexpr double kReliable = 0.1;
constexpr double kWrong_deg = 15.0, kWrongShare = 0.1, kTurned_deg = 10.0;
constexpr double kLargestSquare = 25.0;
constexpr std::size_t kFewestForThirds = 9;
constexpr std::size_t kFramesOfTwoStrides = 17;  // 1.16 s at 15 frames a second

ForeignSample sample_in(const CsvTable& table, std::size_t row) {
  const auto text = [&](const char* column) { return table.text(row, column); };
  const auto number = [&](const char* column) { return table.number(row, column); };
  ForeignSample s;
  s.method = text("method");
  s.image = text("image");
  s.kind = text("kind");
  s.build = text("build");
  s.print = text("print");
  s.t_s = number("t_s");
  s.distance_m = number("distance_m");
  s.yaw_set_deg = number("yaw_set_deg");
  s.yaw_back_deg = number("yaw_back_deg");
  s.yaw_walk_deg = number("yaw_walk_deg");
  s.found = number("found") != 0.0;
  s.certainty = number("certainty");
  s.yaw_deg = number("yaw_deg");
  s.yaw_sigma_deg = number("yaw_sigma_deg");
  s.distance_ratio = number("distance_ratio");
  s.along_m = number("along_m");
  s.across_m = number("across_m");
  return s;
}

/// Between the two nearest ranks, in proportion.
double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const double at = share * static_cast<double>(values.size() - 1);
  const auto low = static_cast<std::size_t>(at);
  const double above = low + 1 < values.size() ? values[low + 1] : values[low];
  return values[low] + (at - static_cast<double>(low)) * (above - values[low]);
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

double root_mean_square(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return values.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(values.size()));
}

double squared_ratio(const ForeignSample& s) {
  return std::min(std::pow(s.error_deg() / s.yaw_sigma_deg, 2), kLargestSquare);
}

std::vector<double> nees_by_sigma(ForeignSamples found) {
  if (found.size() < kFewestForThirds) return {};
  std::stable_sort(found.begin(), found.end(),
                   [](const auto* a, const auto* b) { return a->yaw_sigma_deg < b->yaw_sigma_deg; });
  std::vector<double> thirds;
  for (std::size_t third = 0; third < 3; ++third) {
    std::vector<double> squares;
    for (std::size_t i = found.size() * third / 3; i < found.size() * (third + 1) / 3; ++i)
      squares.push_back(squared_ratio(*found[i]));
    thirds.push_back(mean(squares));
  }
  return thirds;
}

}  // namespace

bool ForeignSample::is_sure() const {
  return found && certainty >= kReliable;
}

bool ForeignSample::is_wrong() const {
  return found && (std::abs(error_deg()) > kWrong_deg || std::abs(distance_ratio - 1.0) > kWrongShare);
}

bool ForeignSample::is_turned() const {
  return std::abs(yaw_back_deg) >= kTurned_deg;
}

std::vector<ForeignSample> read_foreign(const std::string& path) {
  const CsvTable table(path);
  std::vector<ForeignSample> samples;
  for (std::size_t row = 0; row < table.rows(); ++row) samples.push_back(sample_in(table, row));
  return samples;
}

ForeignSamples chosen(const std::vector<ForeignSample>& samples, const ForeignCondition& belongs) {
  ForeignSamples some;
  for (const ForeignSample& sample : samples)
    if (belongs(sample)) some.push_back(&sample);
  return some;
}

ForeignFigures foreign_figures(const ForeignSamples& samples) {
  ForeignFigures f;
  f.pictures = samples.size();
  ForeignSamples found;
  std::vector<double> errors_deg, squares, along_m, across_m, certainties;
  for (const ForeignSample* s : samples) {
    if (!s->found) continue;
    found.push_back(s);
    errors_deg.push_back(std::abs(s->error_deg()));
    squares.push_back(squared_ratio(*s));
    certainties.push_back(s->certainty);
    f.sure += s->is_sure();
    f.wrong += s->is_wrong();
    f.wrong_of_sure += s->is_sure() && s->is_wrong();
    f.turned += s->is_turned();
    f.flips += s->is_turned() && s->yaw_deg * s->yaw_back_deg < 0.0;
    if (s->is_wrong()) continue;
    along_m.push_back(s->along_m);
    across_m.push_back(s->across_m);
  }
  f.found = found.size();
  f.yaw_mean_deg = mean(errors_deg);
  f.yaw_median_deg = percentile(errors_deg, 0.5);
  f.yaw_p95_deg = percentile(errors_deg, 0.95);
  f.nees = mean(squares);
  f.nees_of_thirds = nees_by_sigma(found);
  f.along_rms_m = root_mean_square(along_m);
  f.across_rms_m = root_mean_square(across_m);
  f.certainty_median = percentile(certainties, 0.5);
  return f;
}

std::vector<ForeignGroup> foreign_groups(const std::vector<ForeignSample>& samples) {
  using S = ForeignSample;
  std::vector<ForeignGroup> groups;
  const auto add = [&](const std::string& name, const ForeignCondition& belongs) {
    const ForeignSamples some = chosen(samples, belongs);
    if (!some.empty()) groups.push_back({name, foreign_figures(some)});
  };
  const auto turned = [](const S& s) { return std::abs(s.yaw_set_deg); };
  add("stills, 1-3 m, up to 45",
      [&](const S& s) { return s.is_person() && s.distance_m <= 3.0 && turned(s) < 50.0; });
  add("stills, 4 m, up to 30",
      [&](const S& s) { return s.is_person() && s.distance_m == 4.0 && turned(s) < 35.0; });
  add("stills, 1-3 m, 60",
      [&](const S& s) { return s.is_person() && s.distance_m <= 3.0 && turned(s) >= 50.0; });
  for (const char* kind : {"static", "calm", "rigid", "board", "walk"})
    add(kind, [&](const S& s) { return s.kind == kind; });
  std::set<std::string> prints, builds;
  for (const S& s : samples) {
    if (!s.is_person()) continue;
    prints.insert(s.print);
    builds.insert(s.build);
  }
  for (const std::string& print : prints)
    add("print " + print, [&](const S& s) { return s.is_person() && s.print == print; });
  for (const std::string& build : builds)
    add("build " + build, [&](const S& s) { return s.is_person() && s.build == build; });
  return groups;
}

std::optional<WalkFigures> walk_figures(const std::vector<ForeignSample>& samples) {
  ForeignSamples walk = chosen(samples, [](const ForeignSample& s) { return s.kind == "walk"; });
  if (walk.empty()) return std::nullopt;
  const ForeignSample& last = *walk.back();
  std::erase_if(walk, [&](const auto* s) { return s->build != last.build || s->print != last.print; });
  std::vector<double> changes_deg, off_path_deg, stride_means_deg;
  for (std::size_t i = 0; i < walk.size(); ++i) {
    if (!walk[i]->found) continue;
    off_path_deg.push_back(walk[i]->yaw_deg - walk[i]->yaw_walk_deg);
    if (i > 0 && walk[i - 1]->found) changes_deg.push_back(walk[i]->error_deg() - walk[i - 1]->error_deg());
  }
  if (changes_deg.empty() || off_path_deg.size() <= kFramesOfTwoStrides) return std::nullopt;
  for (std::size_t i = 0; i + kFramesOfTwoStrides <= off_path_deg.size(); ++i) {
    const auto from = off_path_deg.begin() + static_cast<std::ptrdiff_t>(i);
    stride_means_deg.push_back(mean({from, from + kFramesOfTwoStrides}));
  }
  return WalkFigures{root_mean_square(changes_deg), root_mean_square(off_path_deg),
                     root_mean_square(stride_means_deg)};
}

}  // namespace heel::evaluation
