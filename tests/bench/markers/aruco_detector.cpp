#include "bench/markers/marker_detector.h"

#ifdef HEEL_HAVE_ARUCO

#include <Eigen/Core>
#include <opencv2/aruco.hpp>
#include <opencv2/calib3d.hpp>

namespace heel::test {
namespace {

class ArucoDetector : public MarkerDetector {
 public:
  ArucoDetector(const CameraModel& camera, int id)
      : K_(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1),
        id_(id),
        dictionary_(cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50)),
        parameters_(cv::aruco::DetectorParameters::create()) {
    parameters_->cornerRefinementMethod = cv::aruco::CORNER_REFINE_SUBPIX;
  }

  std::optional<Eigen::Matrix3d> rotation(const cv::Mat& grey) override {
    std::vector<std::vector<cv::Point2f>> corners;
    std::vector<int> ids;
    cv::aruco::detectMarkers(grey, dictionary_, corners, ids, parameters_);
    for (std::size_t i = 0; i < ids.size(); ++i)
      if (ids[i] == id_) return rotation_of(corners[i]);
    return std::nullopt;
  }

 private:
  Eigen::Matrix3d rotation_of(const std::vector<cv::Point2f>& corners) const {
    const auto half_m = static_cast<float>(0.5 * kMarkerSide_m);
    const std::vector<cv::Point3f> marker = {
        {-half_m, half_m, 0}, {half_m, half_m, 0}, {half_m, -half_m, 0}, {-half_m, -half_m, 0}};
    cv::Vec3d rotation, translation;
    cv::solvePnP(marker, corners, K_, cv::noArray(), rotation, translation, false, cv::SOLVEPNP_IPPE_SQUARE);
    cv::Matx33d R;
    cv::Rodrigues(rotation, R);
    return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(R.val);
  }

  cv::Matx33d K_;
  int id_;
  cv::Ptr<cv::aruco::Dictionary> dictionary_;
  cv::Ptr<cv::aruco::DetectorParameters> parameters_;
};

}  // namespace

std::unique_ptr<MarkerDetector> make_aruco_detector(const CameraModel& camera, int id) {
  return std::make_unique<ArucoDetector>(camera, id);
}

}  // namespace heel::test

#else

namespace heel::test {

std::unique_ptr<MarkerDetector> make_aruco_detector(const CameraModel& /*camera*/, int /*id*/) {
  return nullptr;
}

}  // namespace heel::test

#endif
