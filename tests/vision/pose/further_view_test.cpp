// A further picture of the back is a view of the template whose features know their places in the reference
// view.
#include "vision/pose/further_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "heel/matching.h"
#include "vision/pose/average_back.h"
#include "vision/pose/rendered_back.h"

namespace heel {
namespace {

/// A template and a picture of its back by the same camera.
struct TurnedBack {
  explicit TurnedBack(double yaw_rad, double depth) {
    shirt = test::shirt();
    shirt.camera = test::robot_camera();  // render_back() makes the pictures of this camera
    surface = average_back(ReferenceView(shirt, VisionConfig{}), VisionConfig{});
    further.R_further_from_ref = test::rotation(yaw_rad, 0.02, -0.01);
    further.t_over_d = test::t_over_d_for(further.R_further_from_ref, 0.05, depth);
    const cv::Mat image = test::render_back(shirt, surface, further.R_further_from_ref, further.t_over_d, 5);
    further.grey.assign(image.data, image.data + image.total());
  }
  ShirtTemplate shirt;
  BackSurface surface;
  FurtherView further;
};

TEST(FurtherView, ItsFeaturesKnowTheirPlacesInTheReferenceView) {
  for (const double yaw_rad : {-0.5, 0.3}) {
    const TurnedBack back(yaw_rad, 1.1);
    const TemplateView view = further_view(back.shirt, back.surface, back.further, 200);
    EXPECT_NEAR(view.yaw_rad, yaw_rad, 0.01);
    ASSERT_GT(view.set.features.size(), 80U);
    ASSERT_EQ(view.ref_px.size(), view.set.features.size());

    const FeatureSet taught = template_features(back.shirt);
    std::vector<Match> matches;
    Matcher(static_cast<int>(taught.features.size()), 200, {}).match(taught, view.set, matches);
    ASSERT_GT(matches.size(), 20U) << yaw_rad;
    int in_place = 0;
    for (const Match& match : matches) {
      const Feature& feature = taught.features[static_cast<std::size_t>(match.ref)];
      const Eigen::Vector2d ref_px = back.shirt.camera.undistort_px({feature.x_px, feature.y_px});
      in_place += (view.ref_px[static_cast<std::size_t>(match.cur)] - ref_px).norm() < 2.0;
    }
    EXPECT_GT(in_place, 0.85 * static_cast<double>(matches.size())) << yaw_rad;
  }
}

TEST(FurtherView, ItsFeaturesPointAtTheMiddleOfTheBackAndKnowTheirScale) {
  const TurnedBack back(0.4, 1.5);
  const TemplateView view = further_view(back.shirt, back.surface, back.further, 200);
  ASSERT_FALSE(view.set.features.empty());
  const Eigen::Vector3d middle(back.surface.axis_x, back.surface.axis_y, 1.0);
  const Eigen::Vector3d seen = back.further.R_further_from_ref * middle + back.further.t_over_d;
  const Eigen::Vector2d centre_px = (back.shirt.camera.K() * seen).hnormalized();
  EXPECT_NEAR(view.scale, 1.0 / seen.z(), 1e-9);
  for (std::size_t i = 0; i < view.set.features.size(); ++i) {
    const Feature& feature = view.set.features[i];
    const Eigen::Vector2d px = back.shirt.camera.undistort_px({feature.x_px, feature.y_px});
    EXPECT_LT((px + view.to_centre_px[i] - centre_px).norm(), 1e-6);
    EXPECT_GT(view.local_scale[i], 0.1);
    EXPECT_LT(view.local_scale[i], 1.2 * view.scale);
  }
}

TEST(FurtherView, JoinsTheViewsThatASearchMatches) {
  TurnedBack back(0.45, 1.0);
  const std::size_t made = make_views(back.shirt, back.surface).size();
  back.shirt.further_views.push_back(back.further);
  const std::vector<TemplateView> views = make_views(back.shirt, back.surface);
  ASSERT_EQ(views.size(), made + 1);
  EXPECT_NEAR(views.back().yaw_rad, 0.45, 0.01);
}

TEST(FurtherView, APictureOfTheInsideHasNoFeatures) {
  TurnedBack back(0.0, 1.0);
  back.further.R_further_from_ref = test::rotation(M_PI, 0.0, 0.0);
  back.further.t_over_d = {0.0, 0.0, 2.0};
  EXPECT_TRUE(further_view(back.shirt, back.surface, back.further, 200).set.features.empty());
}

}  // namespace
}  // namespace heel
