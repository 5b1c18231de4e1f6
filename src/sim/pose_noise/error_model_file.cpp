// The model as TOML: a table a quantity, a key a term.
#include <cstdio>
#include <fstream>

#include "heel/error.h"
#include "sim/pose_noise/error_model.h"
#include "toml/toml_file.h"
#include "toml/toml_section.h"

namespace heel::sim {
namespace {

constexpr NumberRange kAny{-1e6, 1e6, ""};

template <typename Terms, std::size_t N>
void write_terms(std::ostream& out, const Terms& terms, const std::array<const char*, N>& names) {
  for (std::size_t i = 0; i < N; ++i) {
    char line[80];
    std::snprintf(line, sizeof line, "%s = %.8g\n", names[i], terms(static_cast<Eigen::Index>(i)) + 0.0);
    out << line;
  }
}

/// TOML tells whole numbers from others; both are numbers here.
template <typename Terms, std::size_t N>
Terms read_terms(TomlSection section, const std::array<const char*, N>& names) {
  Terms terms;
  for (std::size_t i = 0; i < N; ++i)
    terms(static_cast<Eigen::Index>(i)) = section.required_number(names[i], kAny);
  section.reject_unknown_keys();
  return terms;
}

void write_value(std::ostream& out, const char* name, double value) {
  char line[80];
  std::snprintf(line, sizeof line, "%s = %.8g\n", name, value);
  out << line;
}

void write_spread(std::ostream& out, const std::string& name, const char* what, const SpreadModel& model) {
  out << "\n# " << what << "\n[" << name << "]\n";
  write_value(out, "print_share", model.print_share);
  write_value(out, "memory_s", model.memory_s);
  out << "residual = [";
  for (std::size_t i = 0; i < kQuantiles; ++i) {
    char number[32];
    std::snprintf(number, sizeof number, "%s%.5f", i == 0 ? "" : ", ", model.residual[i]);
    out << number;
  }
  out << "]\n[" << name << ".bias_even]\n";
  write_terms(out, model.bias_even, kEvenTerms);
  out << "[" << name << ".bias_odd]\n";
  write_terms(out, model.bias_odd, kOddTerms);
  out << "[" << name << ".log_spread]\n";
  write_terms(out, model.log_spread, kEvenTerms);
}

SpreadModel read_spread(TomlSection section) {
  SpreadModel model;
  model.print_share = section.required_number("print_share", {0, 1, ""});
  model.memory_s = section.required_number("memory_s", {0, 1000, "s"});
  const std::vector<double> residual = section.numbers("residual", kQuantiles);
  if (residual.empty()) section.fail("residual", "missing (expected 41 quantiles)");
  std::copy(residual.begin(), residual.end(), model.residual.begin());
  model.bias_even = read_terms<EvenTerms>(section.section("bias_even"), kEvenTerms);
  model.bias_odd = read_terms<OddTerms>(section.section("bias_odd"), kOddTerms);
  model.log_spread = read_terms<EvenTerms>(section.section("log_spread"), kEvenTerms);
  section.reject_unknown_keys();
  return model;
}

void write_log(std::ostream& out, const std::string& name, const char* what, const LogModel& model) {
  out << "\n# " << what << "\n[" << name << "]\n";
  write_value(out, "log_deviation", model.log_deviation);
  out << "[" << name << ".log_mean]\n";
  write_terms(out, model.log_mean, kEvenTerms);
}

LogModel read_log(TomlSection section) {
  LogModel model;
  model.log_deviation = section.required_number("log_deviation", {0, 100, ""});
  model.log_mean = read_terms<EvenTerms>(section.section("log_mean"), kEvenTerms);
  section.reject_unknown_keys();
  return model;
}

}  // namespace

ErrorModel read_error_model(const std::string& path) {
  const std::string text = read_toml_text(path, "an error model, as `heel fit` writes it");
  const toml::table table = parse_toml(text, path);
  TomlSection root(table, "", path);
  ErrorModel model;
  model.distance_max_m = root.required_number("distance_max_m", {0, 100, "m"});
  model.aspect_max_rad = root.required_number("aspect_max_rad", {0, 3.2, "rad"});
  model.found_memory_s = root.required_number("found_memory_s", {0, 1000, "s"});
  model.missed_log_time_share = root.required_number("missed_log_time_share", kAny);
  model.found_log_odds = read_terms<EvenTerms>(root.section("found_log_odds"), kEvenTerms);
  model.flip_log_odds = read_terms<EvenTerms>(root.section("flip_log_odds"), kEvenTerms);
  model.aspect_rad = read_spread(root.section("aspect_rad"));
  model.range_share = read_spread(root.section("range_share"));
  model.bearing_rad = read_spread(root.section("bearing_rad"));
  model.certainty = read_log(root.section("certainty"));
  model.yaw_sigma_rad = read_log(root.section("yaw_sigma_rad"));
  model.time_share = read_log(root.section("time_share"));
  root.reject_unknown_keys();
  return model;
}

void write_error_model(const ErrorModel& model, const std::string& note, const std::string& path) {
  std::ofstream out(path);
  out << "# What vision makes of the pictured world, for `heel simulate --error-model`. Written by `heel "
         "fit`.\n# "
      << note
      << "\n# Terms: distance in m, angle to the line of sight in rad, blur in px, dark in halvings of the "
         "light,\n"
         "# hidden as a share of the back's width; src/sim/pose_noise/error_model.h.\n\n";
  write_value(out, "distance_max_m", model.distance_max_m);
  write_value(out, "aspect_max_rad", model.aspect_max_rad);
  write_value(out, "found_memory_s", model.found_memory_s);
  write_value(out, "missed_log_time_share", model.missed_log_time_share);
  out << "\n# the shirt is found\n[found_log_odds]\n";
  write_terms(out, model.found_log_odds, kEvenTerms);
  out << "\n# the estimate has the back turned to the wrong side of the line of sight\n[flip_log_odds]\n";
  write_terms(out, model.flip_log_odds, kEvenTerms);
  write_spread(out, "aspect_rad", "estimated minus true angle of the back to the line of sight",
               model.aspect_rad);
  write_spread(out, "range_share", "estimated over true distance, minus one", model.range_share);
  write_spread(out, "bearing_rad", "estimated minus true direction, right positive", model.bearing_rad);
  write_log(out, "certainty", "inliers over template features", model.certainty);
  write_log(out, "yaw_sigma_rad", "the deviation of yaw that vision states", model.yaw_sigma_rad);
  write_log(out, "time_share", "time of the vision stage over that straight ahead at 2 m, tracked",
            model.time_share);
  if (!out.flush()) throw Error(path + ": cannot write (expected a writable folder)");
}

}  // namespace heel::sim
