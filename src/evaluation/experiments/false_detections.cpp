#include "evaluation/experiments/false_detections.h"

#include <fmt/format.h>

#include <filesystem>

#include "files/csv_file.h"
#include "files/frame_input.h"
#include "files/image_file.h"
#include "heel/pose_tracker.h"

namespace heel::evaluation {
namespace {

constexpr double kAssumedRate_hz = 30.0;  // of images; a video has its own
constexpr double kFocalPerWidth = 0.91;   // a field of view of 58° across

std::string name_of(const ShirtName& shirt) {
  return shirt.first + " " + shirt.second;
}

CameraModel usual_camera(const cv::Mat& grey) {
  CameraModel camera;
  camera.width_px = grey.cols;
  camera.height_px = grey.rows;
  camera.fx = camera.fy = kFocalPerWidth * grey.cols;
  camera.cx = 0.5 * (grey.cols - 1);
  camera.cy = 0.5 * (grey.rows - 1);
  return camera;
}

}  // namespace

FalseDetections search_other_prints(const ForeignSet& set, const ForeignTemplates& templates,
                                    const VisionConfig& vision) {
  FalseDetections result{"every print", "the stills of all other prints", 0, {}};
  VisionConfig still = vision;
  still.tracking = false;
  for (const auto& [name, shirt] : templates.usable) {
    PoseTracker tracker(shirt, set.camera, still);
    for (const ForeignPicture& picture : set.pictures) {
      if (picture.is_taught() || picture.is_in_walk() || picture.print == name.second) continue;
      const cv::Mat grey = read_grey_image(picture.path).grey;
      const PoseEstimate pose = tracker.estimate(frame_view_of(grey));
      ++result.pictures;
      if (pose.found())
        result.found.push_back(
            fmt::format("{} in {} (certainty {:.2f})", name_of(name), picture.image, pose.certainty));
    }
  }
  return result;
}

FalseDetections search_video(const std::string& path, const ForeignTemplates& templates,
                             const VisionConfig& vision) {
  FalseDetections result{
      "every print", "the frames of " + std::filesystem::path(path).filename().string(), 0, {}};
  for (const auto& [name, shirt] : templates.usable) {
    FrameInput input({path}, kAssumedRate_hz);
    InputFrame frame;
    std::unique_ptr<PoseTracker> tracker;
    while (input.next(frame)) {
      if (!tracker) tracker = std::make_unique<PoseTracker>(shirt, usual_camera(frame.grey), vision);
      FrameView view = frame_view_of(frame.grey);
      view.header.sequence = frame.number;
      view.header.t_capture_ns = ns_from_seconds(frame.t_s);
      const PoseEstimate pose = tracker->estimate(view);
      ++result.pictures;
      if (pose.found())
        result.found.push_back(
            fmt::format("{} in frame {} (certainty {:.2f})", name_of(name), frame.number, pose.certainty));
    }
  }
  return result;
}

void write_false_detections(const std::vector<FalseDetections>& all, const std::string& path) {
  CsvFile file(path, "searched_for,in,pictures,found,which");
  for (const FalseDetections& one : all) {
    std::string which;
    for (const std::string& found : one.found) which += (which.empty() ? "" : "; ") + found;
    file.text(one.searched_for).text(one.in).count(one.pictures).count(one.found.size()).text(which);
    file.end_row();
  }
  file.flush();
}

}  // namespace heel::evaluation
