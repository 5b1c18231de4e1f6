#include "evaluation/experiments/real_images.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <filesystem>
#include <fstream>

#include "files/csv_file.h"
#include "files/frame_input.h"
#include "files/image_file.h"
#include "heel/error.h"
#include "heel/pose_estimator.h"

namespace heel::evaluation {
namespace {

namespace fs = std::filesystem;
constexpr std::uint64_t kTemplateFrame = 1000;
constexpr double kImageRate_hz = 30.0;
constexpr Region kBackInVideo{400, 90, 100, 175};

struct Set {
  const char* name;
  const char* extension;
  bool oriented;  ///< the camera was turned about its axis
};
constexpr std::array kSets{Set{"graf", ".ppm", false}, Set{"boat", ".pgm", true},
                           Set{"leuven", ".ppm", false}};

/// A template of `region`. The camera is not known; any focal length gives the same homography.
ShirtTemplate template_of(const cv::Mat& grey, const Region& region, bool oriented) {
  ShirtTemplate shirt;
  shirt.grey.assign(grey.data, grey.data + grey.total());
  shirt.camera.width_px = grey.cols;
  shirt.camera.height_px = grey.rows;
  shirt.camera.fx = shirt.camera.fy = grey.cols;
  shirt.camera.cx = 0.5 * (grey.cols - 1);
  shirt.camera.cy = 0.5 * (grey.rows - 1);
  shirt.roi = region;
  shirt.oriented = oriented;
  return shirt;
}

Eigen::Matrix3d true_homography(const fs::path& path) {
  std::ifstream file(path);
  Eigen::Matrix3d H;
  for (int i = 0; i < 9; ++i) file >> H(i / 3, i % 3);
  if (!file) throw Error(path.string() + ": cannot read (expected nine numbers)");
  return H;
}

double corner_error_px(const cv::Mat& reference, const Eigen::Matrix3d& found, const Eigen::Matrix3d& truth) {
  const double right = reference.cols - 1, bottom = reference.rows - 1;
  double sum_px = 0.0;
  for (const Eigen::Vector2d& corner : {Eigen::Vector2d(0, 0), Eigen::Vector2d(right, 0),
                                        Eigen::Vector2d(right, bottom), Eigen::Vector2d(0, bottom)})
    sum_px +=
        ((found * corner.homogeneous()).hnormalized() - (truth * corner.homogeneous()).hnormalized()).norm();
  return sum_px / 4.0;
}

fs::path homography_file(const fs::path& folder, int to) {
  return folder / fmt::format("H1to{}p", to);
}

PairRow estimate_pair(const fs::path& folder, const Set& set, int to, const VisionConfig& vision) {
  const auto image = [&](int number) {
    return read_grey_image(folder / fmt::format("img{}{}", number, set.extension)).grey;
  };
  const cv::Mat reference = image(1), current = image(to);
  const ShirtTemplate whole = template_of(reference, {0, 0, reference.cols, reference.rows}, set.oriented);
  const PoseEstimate pose = PoseEstimator(whole, whole.camera, vision).estimate(frame_view_of(current));
  PairRow row{set.name, to, pose.found(), to_string(pose.reason), pose.inliers, pose.certainty, 0.0};
  if (row.found)
    row.corner_error_px = corner_error_px(
        reference, Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(pose.H_cur_from_ref.data()),
        true_homography(homography_file(folder, to)));
  return row;
}

}  // namespace

std::vector<PairRow> estimate_pairs(const std::string& data, const VisionConfig& vision) {
  std::vector<PairRow> rows;
  for (const Set& set : kSets) {
    const fs::path folder = fs::path(data) / "oxford" / set.name;
    for (int to = 2; to <= 6; ++to)
      if (fs::exists(homography_file(folder, to))) rows.push_back(estimate_pair(folder, set, to, vision));
  }
  return rows;
}

std::vector<VideoRow> estimate_video(const std::string& data, int step, const VisionConfig& vision) {
  const std::string path = fs::path(data) / "person" / "one-by-one.mp4";
  std::vector<VideoRow> rows;
  if (!fs::exists(path)) return rows;
  // The video is read twice: the template's frame is in its middle.
  InputFrame frame;
  FrameInput first_pass({path}, kImageRate_hz);
  if (!first_pass.skip(kTemplateFrame) || !first_pass.next(frame))
    throw Error(fmt::format("{}: ends before frame {} (expected more frames)", path, kTemplateFrame));
  const ShirtTemplate shirt = template_of(frame.grey, kBackInVideo, false);
  PoseEstimator estimator(shirt, shirt.camera, vision);
  FrameInput second_pass({path}, kImageRate_hz);
  while (second_pass.next(frame)) {
    const PoseEstimate pose = estimator.estimate(frame_view_of(frame.grey));
    rows.push_back({static_cast<int>(frame.number), pose.found(), pose.found() ? pose.certainty : 0.0});
    if (!second_pass.skip(static_cast<std::uint64_t>(step - 1))) break;
  }
  return rows;
}

void write_pairs(const std::vector<PairRow>& rows, const std::string& path) {
  CsvFile file(path, "set,to,found,reason,inliers,certainty,corner_error_px");
  for (const PairRow& row : rows) {
    file.text(row.set).number(row.to, 0).text(row.found ? "1" : "0").text(row.reason).count(row.inliers);
    file.number(row.certainty, 4).number(row.corner_error_px, 3);
    file.end_row();
  }
  file.flush();
}

void write_video(const std::vector<VideoRow>& rows, const std::string& path) {
  CsvFile file(path, "frame,in_view,found,certainty");
  for (const VideoRow& row : rows) {
    const bool in_view = row.frame >= kVideoFirstInView && row.frame <= kVideoLastInView;
    file.number(row.frame, 0).text(in_view ? "1" : "0").text(row.found ? "1" : "0").number(row.certainty, 4);
    file.end_row();
  }
  file.flush();
}

}  // namespace heel::evaluation
