#include "evaluation/experiments/real_images.h"

#include <Eigen/Geometry>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "heel/error.h"
#include "heel/pose_estimator.h"

namespace heel::evaluation {
namespace {

namespace fs = std::filesystem;
constexpr int kTemplateFrame = 1000;
constexpr Region kBackInVideo{400, 90, 100, 175};

struct Set {
  const char* name;
  const char* extension;
  bool oriented;  ///< the camera was turned about its axis
};
constexpr std::array kSets{Set{"graf", ".ppm", false}, Set{"boat", ".pgm", true},
                           Set{"leuven", ".ppm", false}};

/// The camera is not known: any focal length gives the same homography.
ShirtTemplate taught_from(const cv::Mat& grey, const Region& region, bool oriented) {
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

FrameView view_of(const cv::Mat& grey) {
  FrameView view;
  view.header.width_px = static_cast<std::uint32_t>(grey.cols);
  view.header.height_px = static_cast<std::uint32_t>(grey.rows);
  view.grey = grey.data;
  view.stride_bytes = static_cast<std::uint32_t>(grey.step[0]);
  return view;
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

PairRow look_at_pair(const fs::path& folder, const Set& set, int to, const VisionConfig& vision) {
  const auto image = [&](int number) {
    const fs::path path = folder / ("img" + std::to_string(number) + set.extension);
    cv::Mat grey = cv::imread(path, cv::IMREAD_GRAYSCALE);
    if (grey.empty()) throw Error(path.string() + ": cannot read (expected an image)");
    return grey;
  };
  const cv::Mat reference = image(1), current = image(to);
  const ShirtTemplate whole = taught_from(reference, {0, 0, reference.cols, reference.rows}, set.oriented);
  const PoseEstimate pose = PoseEstimator(whole, whole.camera, vision).estimate(view_of(current));
  PairRow row{set.name, to, pose.found(), to_string(pose.reason), pose.inliers, pose.certainty, 0.0};
  if (row.found)
    row.corner_error_px = corner_error_px(
        reference, Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(pose.H_cur_from_ref.data()),
        true_homography(folder / ("H1to" + std::to_string(to) + "p")));
  return row;
}

}  // namespace

std::vector<PairRow> look_at_pairs(const std::string& data, const VisionConfig& vision) {
  std::vector<PairRow> rows;
  for (const Set& set : kSets) {
    const fs::path folder = fs::path(data) / "oxford" / set.name;
    for (int to = 2; to <= 6; ++to)
      if (fs::exists(folder / ("H1to" + std::to_string(to) + "p")))
        rows.push_back(look_at_pair(folder, set, to, vision));
  }
  return rows;
}

std::vector<VideoRow> look_at_video(const std::string& data, int step, const VisionConfig& vision) {
  const fs::path path = fs::path(data) / "person" / "one-by-one.mp4";
  std::vector<VideoRow> rows;
  if (!fs::exists(path)) return rows;
  // Twice through the film: the template's frame stands in its middle.
  cv::VideoCapture first(path.string());
  cv::Mat colour, grey;
  for (int i = 0; i <= kTemplateFrame; ++i)
    if (!first.read(colour))
      throw Error(path.string() + ": ends at frame " + std::to_string(i) +
                  " (expected more than 1000 frames)");
  cv::cvtColor(colour, grey, cv::COLOR_BGR2GRAY);
  const ShirtTemplate shirt = taught_from(grey, kBackInVideo, false);
  PoseEstimator estimator(shirt, shirt.camera, vision);
  cv::VideoCapture film(path.string());
  for (int i = 0; film.read(colour); ++i) {
    if (i % step != 0) continue;
    cv::cvtColor(colour, grey, cv::COLOR_BGR2GRAY);
    const PoseEstimate pose = estimator.estimate(view_of(grey));
    rows.push_back({i, pose.found(), pose.found() ? pose.certainty : 0.0});
  }
  return rows;
}

void write_pairs(const std::vector<PairRow>& rows, const std::string& path) {
  std::ofstream file(path);
  file << "set,to,found,reason,inliers,certainty,corner_error_px\n";
  for (const PairRow& row : rows) {
    char line[160];
    std::snprintf(line, sizeof line, "%s,%d,%d,%s,%u,%.4f,%.3f\n", row.set.c_str(), row.to, row.found ? 1 : 0,
                  row.reason.c_str(), row.inliers, row.certainty, row.corner_error_px);
    file << line;
  }
  if (!file.flush()) throw Error(path + ": cannot write (expected a writable folder)");
}

void write_video(const std::vector<VideoRow>& rows, const std::string& path) {
  std::ofstream file(path);
  file << "frame,in_view,found,certainty\n";
  for (const VideoRow& row : rows) {
    char line[80];
    const bool in_view = row.frame >= kVideoFirstInView && row.frame <= kVideoLastInView;
    std::snprintf(line, sizeof line, "%d,%d,%d,%.4f\n", row.frame, in_view ? 1 : 0, row.found ? 1 : 0,
                  row.certainty);
    file << line;
  }
  if (!file.flush()) throw Error(path + ": cannot write (expected a writable folder)");
}

}  // namespace heel::evaluation
