#include "teach_more.h"

#include <fmt/format.h>

#include <Eigen/Core>

#include "files/frame_input.h"
#include "files/image_file.h"
#include "files/orientation.h"
#include "heel/error.h"
#include "heel/pose_tracker.h"

namespace heel::cli {
namespace {

constexpr double kMinCertainty = 0.1;

using RowMajor3d = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

void require_sure(const PoseEstimate& pose, const std::string& image) {
  if (!pose.found())
    throw Error(fmt::format("--more {}: the shirt is not found: {}", image, to_string(pose.reason)));
  if (pose.certainty < kMinCertainty)
    throw Error(fmt::format("--more {}: the shirt is found with certainty {:.2f} (expected at least {})",
                            image, pose.certainty, kMinCertainty));
}

}  // namespace

std::vector<FurtherView> further_views(const ShirtTemplate& shirt, const std::vector<std::string>& images,
                                       const std::string& camera_file, const PictureTurn& turn) {
  VisionConfig config;
  config.tracking = false;  // the pictures have nothing to do with one another
  PoseTracker tracker(shirt, shirt.camera, config);
  std::vector<FurtherView> views;
  for (const std::string& image : images) {
    FrameInput input({image}, 30.0);
    InputFrame frame;
    if (!input.next(frame)) throw Error(fmt::format("--more {}: no picture in it", image));
    for (const std::string& note : input.notes()) fmt::print(stderr, "heel teach: {}\n", note);
    frame.grey = turned_picture(frame.grey, turn);
    require_size(frame, shirt.camera, camera_file);
    const PoseEstimate pose = tracker.estimate(frame_view_of(frame.grey));
    require_sure(pose, image);
    FurtherView& view = views.emplace_back();
    view.grey.assign(frame.grey.datastart, frame.grey.dataend);
    view.R_further_from_ref = Eigen::Map<const RowMajor3d>(pose.R_cur_from_ref.data());
    view.t_over_d = Eigen::Map<const Eigen::Vector3d>(pose.t_over_d.data());
  }
  return views;
}

}  // namespace heel::cli
