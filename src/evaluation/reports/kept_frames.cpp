// Which of the camera pictures a run kept are shown, and the quadrilateral the homography recovers in each.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <opencv2/imgcodecs.hpp>

#include "core/angles.h"
#include "evaluation/reports/run_numbers.h"
#include "files/csv_file.h"
#include "files/template_file.h"
#include "heel/shirt_template.h"
#include "recording/recording_reader.h"

namespace heel::evaluation {
namespace {

constexpr std::size_t kColumns = 4;
constexpr std::size_t kMostTiles = 12;

/// The template's region carried into the frame; distorted pixels.
std::array<Eigen::Vector2d, 4> quadrilateral(const ShirtTemplate& shirt, const PoseEstimate& pose) {
  Eigen::Matrix3d H;
  for (int i = 0; i < 9; ++i) H(i / 3, i % 3) = pose.H_cur_from_ref[static_cast<std::size_t>(i)];
  const Region& roi = shirt.roi;
  std::array<Eigen::Vector2d, 4> corners{Eigen::Vector2d(roi.x_px, roi.y_px),
                                         Eigen::Vector2d(roi.x_px + roi.width_px, roi.y_px),
                                         Eigen::Vector2d(roi.x_px + roi.width_px, roi.y_px + roi.height_px),
                                         Eigen::Vector2d(roi.x_px, roi.y_px + roi.height_px)};
  for (Eigen::Vector2d& corner : corners) {
    const Eigen::Vector3d p = H * shirt.camera.undistort_px(corner).homogeneous();
    corner = shirt.camera.distort_px(p.hnormalized());
  }
  return corners;
}

struct KeptFrame {
  std::filesystem::path file;
  std::size_t pose;  ///< of the recording's poses
};

class Poses final : public RecordingVisitor {
 public:
  void on_pose(const PoseEstimate& pose) override { all.push_back(pose); }
  bool wants(std::string_view topic) const override { return topic == "/heel/pose"; }
  std::vector<PoseEstimate> all;
};

/// Whole pictures of the template's size which the vision stage has seen, in order. A run that was cut short
/// may leave half a picture.
std::vector<KeptFrame> usable_frames(const std::string& directory, const std::vector<PoseEstimate>& poses,
                                     const CameraModel& camera) {
  std::map<unsigned long long, std::size_t> pose_of;
  for (std::size_t i = 0; i < poses.size(); ++i) pose_of[poses[i].frame_sequence] = i;
  std::vector<KeptFrame> frames;
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    const auto pose = pose_of.find(std::strtoull(entry.path().stem().c_str(), nullptr, 10));
    if (pose == pose_of.end()) continue;
    const cv::Mat picture = cv::imread(entry.path().string(), cv::IMREAD_COLOR);
    if (picture.cols == camera.width_px && picture.rows == camera.height_px)
      frames.push_back({entry.path(), pose->second});
  }
  std::sort(frames.begin(), frames.end(),
            [](const KeptFrame& a, const KeptFrame& b) { return a.pose < b.pose; });
  return frames;
}

/// As many of them as fill whole rows, evenly spread, the first and the last among them.
std::vector<KeptFrame> chosen_frames(const std::vector<KeptFrame>& frames) {
  const std::size_t rows = std::min(frames.size(), kMostTiles) / kColumns;
  const std::size_t wanted = rows > 0 ? rows * kColumns : frames.size();
  if (wanted < 2) return frames;
  std::vector<KeptFrame> chosen;
  for (std::size_t i = 0; i < wanted; ++i)
    chosen.push_back(frames[(2 * i * (frames.size() - 1) + wanted - 1) / (2 * (wanted - 1))]);
  return chosen;
}

}  // namespace

void write_kept_frames(const std::string& directory, double t_begin_s) {
  namespace fs = std::filesystem;
  if (!fs::is_directory(directory + "/frames") || !fs::exists(directory + "/shirt.heel")) return;
  const ShirtTemplate shirt = read_template(directory + "/shirt.heel");
  Poses poses;
  read_recording(recording_in(directory), poses);
  CsvFile file(directory + "/frames.csv",
               "file,t_s,found,yaw_deg,certainty,corner_0_x_px,corner_0_y_px,corner_1_x_px,corner_1_y_px,"
               "corner_2_x_px,corner_2_y_px,corner_3_x_px,corner_3_y_px");
  for (const KeptFrame& kept : chosen_frames(usable_frames(directory + "/frames", poses.all, shirt.camera))) {
    const PoseEstimate& pose = poses.all[kept.pose];
    const bool found = pose.found();
    file.text("frames/" + kept.file.filename().string());
    file.number(seconds_from_ns(pose.t_capture_ns) - t_begin_s, 3).count(found ? 1 : 0);
    file.number(found ? kDegPerRad * pose.yaw_rad : kNoValue, 2);
    file.number(found ? pose.certainty : 0.0, 4);
    std::array<Eigen::Vector2d, 4> corners;
    corners.fill(Eigen::Vector2d(kNoValue, kNoValue));
    if (found) corners = quadrilateral(shirt, pose);
    for (const Eigen::Vector2d& corner_px : corners) file.number(corner_px.x(), 2).number(corner_px.y(), 2);
    file.end_row();
  }
  file.flush();
}

}  // namespace heel::evaluation
