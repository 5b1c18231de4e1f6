#include "evaluation/experiments/foreign_set.h"

#include "files/camera_info.h"
#include "files/csv_table.h"
#include "files/image_file.h"

namespace heel::evaluation {
namespace {

ForeignPicture picture_in(const CsvTable& table, std::size_t row, const std::string& folder) {
  const auto text = [&](const char* column) { return table.text(row, column); };
  const auto number = [&](const char* column) { return table.number(row, column); };
  const auto pixels = [&](const char* column) { return static_cast<int>(number(column)); };
  ForeignPicture picture;
  picture.image = text("image");
  picture.path = folder + "/images/" + picture.image;
  picture.kind = text("kind");
  picture.build = text("build");
  picture.print = text("print");
  picture.pose = text("pose");
  picture.room = text("room");
  picture.t_s = number("t_s");
  picture.distance_m = number("distance_m");
  picture.yaw_set_deg = number("yaw_set_deg");
  picture.yaw_back_deg = number("yaw_back_deg");
  picture.yaw_walk_deg = number("yaw_walk_deg");
  picture.cloth_moved_mm = number("back_fit_rms_depth_mm");
  picture.centre_m = {number("centre_x_m"), number("centre_y_m"), number("centre_z_m")};
  picture.roi = {pixels("roi_x"), pixels("roi_y"), pixels("roi_w"), pixels("roi_h")};
  picture.teach_distance_m = number("teach_distance_m");
  return picture;
}

ShirtTemplate template_of(const ForeignPicture& picture, const CameraModel& camera) {
  const cv::Mat grey = read_grey_image(picture.path).grey;
  ShirtTemplate shirt;
  shirt.grey.assign(grey.data, grey.data + grey.total());
  shirt.camera = camera;
  shirt.roi = picture.roi;
  shirt.distance_m = picture.teach_distance_m;
  return shirt;
}

}  // namespace

bool ForeignPicture::is_taught() const {
  return kind == "teach" || image.find("teach") != std::string::npos;
}

bool ForeignPicture::is_person() const {
  return kind == "static" || kind == "calm" || kind == "rigid";
}

ForeignSet read_foreign_set(const std::string& folder) {
  ForeignSet set;
  set.camera = read_camera_model(folder + "/camera.yaml");
  const CsvTable table(folder + "/truth.csv");
  for (std::size_t row = 0; row < table.rows(); ++row) set.pictures.push_back(picture_in(table, row, folder));
  return set;
}

ForeignTemplates teach_foreign_set(const ForeignSet& set) {
  ForeignTemplates templates;
  for (const ForeignPicture& picture : set.pictures) {
    if (!picture.is_taught()) continue;
    ShirtTemplate shirt = template_of(picture, set.camera);
    const TemplateVerdict verdict = judge_template(shirt);
    if (verdict.usable) {
      templates.usable.emplace(shirt_of(picture), std::move(shirt));
    } else {
      templates.refused.emplace(shirt_of(picture), verdict.reason);
    }
  }
  return templates;
}

}  // namespace heel::evaluation
