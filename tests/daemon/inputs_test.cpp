// What heeld's configuration asks of the camera: the person is kept inside the picture.
#include "daemon/inputs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/complaint.h"

namespace heel {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class InputsAgainstCamera : public ::testing::Test {
 protected:
  InputsAgainstCamera() {
    config.camera.info = "camera.yaml";
    camera.width_px = 640;
    camera.height_px = 480;
    camera.fx = camera.fy = 600.0;
    camera.cx = 319.5;
    camera.cy = 239.5;
  }
  std::string complaint() {
    return test::complaint_of([&] { check_against_camera(config, camera); });
  }

  Config config;
  CameraModel camera;
};

TEST_F(InputsAgainstCamera, TheBearingEndsAtTheEdgeOfThePicture) {
  const double edge_rad = std::atan(320.0 / 600.0);
  config.control.bearing_max_rad = edge_rad - 1e-6;
  EXPECT_EQ(complaint(), "accepted");
  config.control.bearing_max_rad = edge_rad + 1e-6;
  EXPECT_THAT(complaint(), AllOf(HasSubstr("control.bearing_max_rad: "), HasSubstr("less than 0.489957 rad"),
                                 HasSubstr("camera.yaml")));
}

TEST_F(InputsAgainstCamera, TheNearerEdgeCounts) {
  config.control.bearing_max_rad = 0.45;
  for (const double cx_px : {219.5, 419.5}) {
    camera.cx = cx_px;
    EXPECT_THAT(complaint(), HasSubstr("less than 0.351445 rad")) << "220 px of 600";
  }
}

TEST_F(InputsAgainstCamera, TheLensCounts) {
  camera.lens = LensModel::Fisheye;
  camera.fx = camera.fy = 250.0;
  config.control.bearing_max_rad = 1.1;
  EXPECT_EQ(complaint(), "accepted") << "320 px of 250 are 1.28 rad, of a pinhole 0.91 rad";
  config.control.bearing_max_rad = 1.3;
  EXPECT_THAT(complaint(), HasSubstr("less than 1.28 rad"));
  camera.lens = LensModel::PlumbBob;
  camera.fx = camera.fy = 600.0;
  camera.k1 = 0.2;  // pincushion: less is seen than by a pinhole
  config.control.bearing_max_rad = 0.48;
  EXPECT_THAT(complaint(), HasSubstr("control.bearing_max_rad: 0.48"));
}

TEST_F(InputsAgainstCamera, TheTrailHasItsOwnBearing) {
  config.control.trail_bearing_rad = 0.5;
  EXPECT_EQ(complaint(), "accepted") << "the law " << config.control.law << " does not use it";
  config.control.law = "trail";
  EXPECT_THAT(complaint(), HasSubstr("control.trail_bearing_rad: 0.5 (expected less than 0.489957 rad"));
  config.control.trail_bearing_rad = 0.44;
  EXPECT_EQ(complaint(), "accepted");
}

}  // namespace
}  // namespace heel
