#include "evaluation/reports/paper_numbers.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/angles.h"
#include "files/atomic_file.h"
#include "files/csv_file.h"

namespace heel::evaluation {
namespace {

void append_position_cells(CsvFile& file, const MotionSample& sample) {
  file.number(sample.robot.x_m, 4).number(sample.robot.y_m, 4);
  file.number(sample.has_person ? sample.person.x_m : kNoValue, 4);
  file.number(sample.has_person ? sample.person.y_m : kNoValue, 4);
}

void append_run_rows(CsvFile& file, const char* name, const MetricsCollector& run) {
  for (const MotionSample& sample : run.motion()) {
    append_position_cells(file.text(name), sample);
    file.end_row();
  }
}

}  // namespace

void write_response(const std::string& directory, const MetricsCollector& run) {
  CsvFile file(directory + "/fig7_response.csv",
               "driven_m,robot_x_m,robot_y_m,person_x_m,person_y_m,offset_m,heading_deg");
  double driven_m = 0.0;
  for (std::size_t i = 0; i < run.motion().size(); ++i) {
    const MotionSample& now = run.motion()[i];
    if (i > 0) {
      const Pose2& before = run.motion()[i - 1].robot;
      driven_m += std::hypot(now.robot.x_m - before.x_m, now.robot.y_m - before.y_m);
    }
    // The person walks straight on: their line is where they are and where they face.
    const double c = std::cos(now.person.heading_rad), s = std::sin(now.person.heading_rad);
    const double offset_m = -s * (now.robot.x_m - now.person.x_m) + c * (now.robot.y_m - now.person.y_m);
    append_position_cells(file.number(driven_m, 4), now);
    file.number(offset_m, 4);
    file.number(kDegPerRad * wrap_angle_rad(now.robot.heading_rad - now.person.heading_rad), 3);
    file.end_row();
  }
  file.flush();
}

void write_walk(const std::string& directory, const MetricsCollector& run,
                const MetricsCollector* position_only) {
  CsvFile file(directory + "/fig8_walk.csv", "run,robot_x_m,robot_y_m,person_x_m,person_y_m");
  const FollowMetrics metrics = run.evaluate();
  nlohmann::ordered_json json{{"person_path_m", metrics.person_path_m},
                              {"following_rms_m", metrics.lateral_m.rms}};
  append_run_rows(file, "walk", run);
  if (position_only != nullptr) {
    append_run_rows(file, "walk-position-only", *position_only);
    json["position_only_rms_m"] = position_only->evaluate().lateral_m.rms;
  }
  file.flush();
  write_file_atomically(directory + "/fig8_walk.json", json.dump(2) + "\n");
}

}  // namespace heel::evaluation
