// The error model as TOML: a section for each quantity, a key for each term.
#include <fmt/ranges.h>

#include "files/output_file.h"
#include "sim/pose_noise/error_model.h"
#include "toml/toml_file.h"
#include "toml/toml_section.h"

namespace heel::sim {
namespace {

constexpr NumberRange kAny{-1e6, 1e6, ""};

void write_value(OutputFile& file, const char* name, double value) {
  file.print("{} = {:.8g}\n", name, value);
}

template <typename Terms, std::size_t N>
void write_terms(OutputFile& file, const Terms& terms, const std::array<const char*, N>& names) {
  // Adding 0 makes 0 of −0.
  for (std::size_t i = 0; i < N; ++i) write_value(file, names[i], terms(static_cast<Eigen::Index>(i)) + 0.0);
}

template <typename Terms, std::size_t N>
Terms read_terms(TomlSection section, const std::array<const char*, N>& names) {
  Terms terms;
  for (std::size_t i = 0; i < N; ++i)
    terms(static_cast<Eigen::Index>(i)) = section.required_number(names[i], kAny);
  section.reject_unknown_keys();
  return terms;
}

void write_spread(OutputFile& file, const std::string& name, const char* comment, const SpreadModel& model) {
  file.print("\n# {}\n[{}]\n", comment, name);
  write_value(file, "print_share", model.print_share);
  write_value(file, "memory_s", model.memory_s);
  file.print("residual = [{:.5f}]\n", fmt::join(model.residual, ", "));
  file.print("[{}.bias_even]\n", name);
  write_terms(file, model.bias_even, kEvenTerms);
  file.print("[{}.bias_odd]\n", name);
  write_terms(file, model.bias_odd, kOddTerms);
  file.print("[{}.log_spread]\n", name);
  write_terms(file, model.log_spread, kEvenTerms);
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

void write_log(OutputFile& file, const std::string& name, const char* comment, const LogModel& model) {
  file.print("\n# {}\n[{}]\n", comment, name);
  write_value(file, "log_deviation", model.log_deviation);
  file.print("[{}.log_mean]\n", name);
  write_terms(file, model.log_mean, kEvenTerms);
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
  const std::string text = read_toml_text(path, "an error model written by `heel fit`");
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
  OutputFile file(path);
  file.print(
      "# Pose-noise model for `heel simulate --error-model`. Written by `heel fit`.\n"
      "# {}\n"
      "# Terms: distance in m, angle to the line of sight in rad, blur in px, dark in halvings of the "
      "light,\n"
      "# hidden as a share of the back's width; src/sim/pose_noise/error_model.h.\n\n",
      note);
  write_value(file, "distance_max_m", model.distance_max_m);
  write_value(file, "aspect_max_rad", model.aspect_max_rad);
  write_value(file, "found_memory_s", model.found_memory_s);
  write_value(file, "missed_log_time_share", model.missed_log_time_share);
  file.write("\n# the shirt is found\n[found_log_odds]\n");
  write_terms(file, model.found_log_odds, kEvenTerms);
  file.write(
      "\n# the estimate has the back turned to the wrong side of the line of sight\n[flip_log_odds]\n");
  write_terms(file, model.flip_log_odds, kEvenTerms);
  write_spread(file, "aspect_rad", "estimated minus true angle of the back to the line of sight",
               model.aspect_rad);
  write_spread(file, "range_share", "estimated over true distance, minus one", model.range_share);
  write_spread(file, "bearing_rad", "estimated minus true direction, right positive", model.bearing_rad);
  write_log(file, "certainty", "inliers over template features", model.certainty);
  write_log(file, "yaw_sigma_rad", "the deviation of yaw that vision states", model.yaw_sigma_rad);
  write_log(file, "time_share", "time of the vision stage over that straight ahead at 2 m, tracked",
            model.time_share);
  file.flush();
}

}  // namespace heel::sim
