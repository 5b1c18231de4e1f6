#include "bench/markers/marker_detector.h"

#ifdef HEEL_HAVE_APRILTAG

#include <apriltag/apriltag.h>
#include <apriltag/apriltag_pose.h>
#include <apriltag/tag36h11.h>

#include <cstdlib>

namespace heel::test {
namespace {

class AprilTagDetector : public MarkerDetector {
 public:
  AprilTagDetector(const CameraModel& camera, int id)
      : camera_(camera), id_(id), family_(tag36h11_create()), detector_(apriltag_detector_create()) {
    apriltag_detector_add_family(detector_, family_);
    detector_->quad_decimate = 1.0F;  // the whole resolution: it finds more, and takes longer
    detector_->refine_edges = true;
  }
  ~AprilTagDetector() override {
    apriltag_detector_destroy(detector_);
    tag36h11_destroy(family_);
  }
  AprilTagDetector(const AprilTagDetector&) = delete;
  AprilTagDetector& operator=(const AprilTagDetector&) = delete;

  std::optional<Eigen::Matrix3d> rotation(const cv::Mat& grey) override {
    image_u8_t image{grey.cols, grey.rows, static_cast<int>(grey.step), const_cast<std::uint8_t*>(grey.data)};
    zarray_t* detections = apriltag_detector_detect(detector_, &image);
    std::optional<Eigen::Matrix3d> R;
    for (int i = 0; i < zarray_size(detections) && !R; ++i) {
      apriltag_detection_t* detection = nullptr;
      zarray_get(detections, i, &detection);
      if (detection->id == id_) R = rotation_of(detection);
    }
    apriltag_detections_destroy(detections);
    return R;
  }

 private:
  Eigen::Matrix3d rotation_of(apriltag_detection_t* detection) const {
    // In its pixels, the first one's centre is at (0.5, 0.5).
    apriltag_detection_info_t info{detection,  kMarkerSide_m,    camera_.fx,
                                   camera_.fy, camera_.cx + 0.5, camera_.cy + 0.5};
    apriltag_pose_t pose{};
    estimate_tag_pose(&info, &pose);
    const Eigen::Matrix3d R = Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(pose.R->data);
    std::free(pose.R);  // matd_destroy() does the same, but Debian's library does not export it
    std::free(pose.t);
    return R;
  }

  CameraModel camera_;
  int id_;
  apriltag_family_t* family_;
  apriltag_detector_t* detector_;
};

}  // namespace

std::unique_ptr<MarkerDetector> make_apriltag_detector(const CameraModel& camera, int id) {
  return std::make_unique<AprilTagDetector>(camera, id);
}

}  // namespace heel::test

#else

namespace heel::test {

std::unique_ptr<MarkerDetector> make_apriltag_detector(const CameraModel& /*camera*/, int /*id*/) {
  return nullptr;
}

}  // namespace heel::test

#endif
