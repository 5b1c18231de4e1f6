// heel_bench_markers FOLDER OUT.csv: what AprilTag and ArUco say about the pictures of FOLDER (images/,
// truth.csv, camera.yaml), in which people have a marker on their backs. Yaw against the marker's own taught
// picture, as heel's is. `heel report` sets heel's figures beside it.
#include <fmt/format.h>

#include <cmath>
#include <exception>
#include <filesystem>

#include "bench/markers/marker_detector.h"
#include "core/angles.h"
#include "files/camera_info.h"
#include "files/csv_file.h"
#include "files/csv_table.h"
#include "files/image_file.h"
#include "heel/error.h"

namespace heel::test {
namespace {

constexpr int kAprilTagId = 0, kArucoId = 7;

class Markers {
 public:
  Markers(std::string folder, const std::string& out)
      : folder_(std::move(folder)),
        truth_(folder_ + "/truth.csv"),
        out_(out, "method,image,same_scene_as,distance_m,yaw_set_deg,yaw_back_deg,found,yaw_deg") {}

  /// Rows of the pictures whose column `marker` starts with `marker`.
  void add(const std::string& method, const std::string& marker, MarkerDetector* detector) {
    if (detector == nullptr) {
      fmt::print("{}: SKIPPED: this program was built without its library\n", method);
      return;
    }
    std::size_t pictures = 0, found = 0;
    const Eigen::Matrix3d R_taught = taught_rotation(marker, *detector);
    for (std::size_t row = 0; row < truth_.rows(); ++row) {
      if (!truth_.text(row, "marker").starts_with(marker) || truth_.text(row, "kind") == "teach") continue;
      const auto R = detector->rotation(picture(row));
      const Eigen::Matrix3d R_cur_from_ref = R ? Eigen::Matrix3d(*R * R_taught.transpose()) : R_taught;
      const double yaw_rad = std::atan2(R_cur_from_ref(0, 2), R_cur_from_ref(2, 2));
      out_.text(method).text(truth_.text(row, "image")).text(truth_.text(row, "same_scene_as"));
      for (const char* column : {"distance_m", "yaw_set_deg", "yaw_back_deg"})
        out_.number(truth_.number(row, column), 6);
      out_.text(R ? "1" : "0").number(R ? yaw_rad * kDegPerRad : kNoValue, 6);
      out_.end_row();
      ++pictures;
      found += R ? 1 : 0;
    }
    out_.flush();
    fmt::print("{}: found in {} of {} pictures\n", method, found, pictures);
  }

 private:
  cv::Mat picture(std::size_t row) const {
    return read_grey_image(folder_ + "/images/" + truth_.text(row, "image")).grey;
  }
  Eigen::Matrix3d taught_rotation(const std::string& marker, MarkerDetector& detector) const {
    for (std::size_t row = 0; row < truth_.rows(); ++row) {
      if (!truth_.text(row, "marker").starts_with(marker) || truth_.text(row, "kind") != "teach") continue;
      if (const auto R = detector.rotation(picture(row))) return *R;
    }
    throw Error(folder_ + ": no taught picture in which the " + marker + " is found");
  }

  std::string folder_;
  CsvTable truth_;
  CsvFile out_;
};

}  // namespace
}  // namespace heel::test

int main(int argc, char** argv) {
  using namespace heel;
  try {
    if (argc != 3) throw Error("expected FOLDER OUT.csv");
    const std::string folder = argv[1];
    const CameraModel camera = read_camera_model(folder + "/camera.yaml");
    test::Markers markers(folder, argv[2]);
    markers.add("AprilTag", "apriltag", test::make_apriltag_detector(camera, test::kAprilTagId).get());
    markers.add("ArUco", "aruco", test::make_aruco_detector(camera, test::kArucoId).get());
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "heel_bench_markers: {}\n", error.what());
    return 2;
  }
}
