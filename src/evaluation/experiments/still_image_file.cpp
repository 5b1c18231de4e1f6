#include "evaluation/experiments/still_image_file.h"

#include <array>

#include "files/csv_file.h"

namespace heel::evaluation {
namespace {

struct Column {
  const char* name;
  int decimals;
  double (*value)(const StillImageRow& row);
};

// Angles in radians, lengths in metres. Estimates of a picture in which nothing was found are 0.
constexpr std::array kColumns{
    Column{"seed", 0, [](const StillImageRow& r) { return static_cast<double>(r.world.seed); }},
    Column{"light", 3, [](const StillImageRow& r) { return r.world.light; }},
    Column{"x_m", 4, [](const StillImageRow& r) { return r.view.x_m; }},
    Column{"z_m", 4, [](const StillImageRow& r) { return r.view.z_m; }},
    Column{"yaw_rad", 5, [](const StillImageRow& r) { return r.view.yaw_rad; }},
    Column{"blur_px", 3, [](const StillImageRow& r) { return r.view.blur_px; }},
    Column{"occluded", 3, [](const StillImageRow& r) { return r.view.occluded; }},
    Column{"picture", 0, [](const StillImageRow& r) { return static_cast<double>(r.picture); }},
    Column{"true_x_m", 5, [](const StillImageRow& r) { return r.true_x_m; }},
    Column{"true_y_m", 5, [](const StillImageRow& r) { return r.true_y_m; }},
    Column{"true_z_m", 5, [](const StillImageRow& r) { return r.true_z_m; }},
    Column{"true_yaw_rad", 6, [](const StillImageRow& r) { return r.true_yaw_rad; }},
    Column{"true_t_x_m", 5, [](const StillImageRow& r) { return r.true_t_m.x(); }},
    Column{"true_t_z_m", 5, [](const StillImageRow& r) { return r.true_t_m.z(); }},
    Column{"found", 0, [](const StillImageRow& r) { return r.pose.found() ? 1.0 : 0.0; }},
    Column{"tracked", 0, [](const StillImageRow& r) { return r.pose.tracked ? 1.0 : 0.0; }},
    Column{"inliers", 0, [](const StillImageRow& r) { return static_cast<double>(r.pose.inliers); }},
    Column{"certainty", 4, [](const StillImageRow& r) { return r.pose.certainty; }},
    Column{"est_yaw_rad", 6, [](const StillImageRow& r) { return r.pose.yaw_rad; }},
    Column{"est_yaw_sigma_rad", 6, [](const StillImageRow& r) { return r.pose.yaw_sigma_rad; }},
    Column{"est_x_m", 5, [](const StillImageRow& r) { return r.pose.position_m[0]; }},
    Column{"est_y_m", 5, [](const StillImageRow& r) { return r.pose.position_m[1]; }},
    Column{"est_z_m", 5, [](const StillImageRow& r) { return r.pose.position_m[2]; }},
    Column{"est_t_x_m", 5, [](const StillImageRow& r) { return r.t_m[0]; }},
    Column{"est_t_x_sigma_m", 5, [](const StillImageRow& r) { return r.t_sigma_m[0]; }},
    Column{"est_t_z_m", 5, [](const StillImageRow& r) { return r.t_m[2]; }},
    Column{"est_t_z_sigma_m", 5, [](const StillImageRow& r) { return r.t_sigma_m[2]; }},
    Column{"corner_0_x_px", 1, [](const StillImageRow& r) { return r.outline_px[0].x(); }},
    Column{"corner_0_y_px", 1, [](const StillImageRow& r) { return r.outline_px[0].y(); }},
    Column{"corner_1_x_px", 1, [](const StillImageRow& r) { return r.outline_px[1].x(); }},
    Column{"corner_1_y_px", 1, [](const StillImageRow& r) { return r.outline_px[1].y(); }},
    Column{"corner_2_x_px", 1, [](const StillImageRow& r) { return r.outline_px[2].x(); }},
    Column{"corner_2_y_px", 1, [](const StillImageRow& r) { return r.outline_px[2].y(); }},
    Column{"corner_3_x_px", 1, [](const StillImageRow& r) { return r.outline_px[3].x(); }},
    Column{"corner_3_y_px", 1, [](const StillImageRow& r) { return r.outline_px[3].y(); }},
    Column{"vision_ms", 3, [](const StillImageRow& r) { return r.vision_ms; }},
};

}  // namespace

void write_still_images(const std::vector<StillImageRow>& rows, const std::string& path) {
  std::string header = "name,shirt,reason";
  for (const Column& column : kColumns) header += std::string(",") + column.name;
  CsvFile file(path, header);
  for (const StillImageRow& row : rows) {
    file.text(row.name).text(row.world.shirt).text(to_string(row.pose.reason));
    for (const Column& column : kColumns) file.number(column.value(row), column.decimals);
    file.end_row();
  }
  file.flush();
}

}  // namespace heel::evaluation
