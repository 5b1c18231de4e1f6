// Views of the template show what a camera would see of the turned back, and each feature of a view knows its
// place in the reference view.
#include "vision/pose/template_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "heel/matching.h"
#include "vision/pose/average_back.h"
#include "vision/pose/rendered_back.h"

namespace heel {
namespace {

BackSurface surface_of(const ShirtTemplate& shirt) {
  return average_back(ReferenceView(shirt, VisionConfig{}), VisionConfig{});
}

TEST(TemplateView, TheViewFromTheTemplatesPlaceIsTheTemplate) {
  const ShirtTemplate shirt = test::shirt();
  const TemplateView view = make_view(shirt, surface_of(shirt), 0.0, 1.0, 200);
  const FeatureSet taught = template_features(shirt);
  std::vector<Match> matches;
  Matcher(static_cast<int>(taught.features.size()), 200, {}).match(taught, view.set, matches);
  ASSERT_GT(matches.size(), 80U);
  int in_place = 0;
  for (const Match& match : matches) {
    const Feature& feature = taught.features[static_cast<std::size_t>(match.ref)];
    const Eigen::Vector2d ref_px = shirt.camera.undistort_px({feature.x_px, feature.y_px});
    in_place += (view.ref_px[static_cast<std::size_t>(match.cur)] - ref_px).norm() < 0.7;
  }
  EXPECT_GT(in_place, 0.95 * static_cast<double>(matches.size()));
}

// The independent renderer of this test shows the back as the robot's camera sees it, through its lens.
TEST(TemplateView, ATurnedViewMatchesWhatACameraSees) {
  const ShirtTemplate shirt = test::shirt();
  const BackSurface surface = surface_of(shirt);
  const CameraModel camera = test::robot_camera();
  const Eigen::Matrix3d K_ref_inverse = shirt.camera.K().inverse();
  for (const double yaw_rad : {-M_PI / 3.0, M_PI / 6.0}) {
    const Eigen::Matrix3d R = test::rotation(yaw_rad, 0.0, 0.0);
    const Eigen::Vector3d t = test::t_over_d_for(R, 0.0, 1.0);
    const cv::Mat image = test::render_back(shirt, surface, R, t, 5);
    FeatureSettings settings;
    settings.max_features = 1000;
    FeatureSet seen;
    FeatureExtractor(camera.width_px, camera.height_px, settings).extract(test::view_of(image), seen);

    const auto right_matches = [&](const FeatureSet& set, const std::vector<Eigen::Vector2d>& ref_px) {
      std::vector<Match> matches;
      Matcher(static_cast<int>(set.features.size()), 1000, {}).match(set, seen, matches);
      return std::count_if(matches.begin(), matches.end(), [&](const Match& match) {
        const Eigen::Vector3d ray = K_ref_inverse * ref_px[static_cast<std::size_t>(match.ref)].homogeneous();
        const Eigen::Vector2d true_px =
            camera.distort_px((camera.K() * (R * surface.point(ray) + t)).hnormalized());
        const Feature& feature = seen.features[static_cast<std::size_t>(match.cur)];
        return (true_px - Eigen::Vector2d(feature.x_px, feature.y_px)).norm() < 1.5;
      });
    };
    const TemplateView view = make_view(shirt, surface, yaw_rad, 1.0, 200);
    const FeatureSet taught = template_features(shirt);
    std::vector<Eigen::Vector2d> taught_px;
    for (const Feature& feature : taught.features)
      taught_px.push_back(shirt.camera.undistort_px({feature.x_px, feature.y_px}));
    const auto of_view = right_matches(view.set, view.ref_px), of_template = right_matches(taught, taught_px);
    EXPECT_GT(of_view, 40) << yaw_rad;
    if (std::abs(yaw_rad) > 1.0) {
      EXPECT_GT(of_view, 3 * of_template) << "the template's own features are not found at 60 degrees";
    }
  }
}

TEST(TemplateView, FeaturesKnowTheMiddleOfTheBackAndTheirScale) {
  const ShirtTemplate shirt = test::shirt();
  const TemplateView half = make_view(shirt, surface_of(shirt), 0.0, 0.5, 200);
  ASSERT_GT(half.set.features.size(), 30U);
  const Eigen::Vector2d middle_px = ReferenceView(shirt, VisionConfig{}).centre_px;
  for (std::size_t i = 0; i < half.set.features.size(); ++i) {
    EXPECT_NEAR(half.local_scale[i], 0.5, 0.05);
    EXPECT_LT((half.to_centre_px[i] - 0.5 * (middle_px - half.ref_px[i])).norm(), 4.0);
  }
}

TEST(TemplateView, TheNearestViewIsTheMostAlike) {
  std::vector<TemplateView> views(4);
  views[1].yaw_rad = 1.0;
  views[2].scale = 0.5;
  views[3].yaw_rad = 1.0;
  views[3].scale = 0.5;
  EXPECT_EQ(&nearest_view(views, 0.1, 1.2), &views[0]);
  EXPECT_EQ(&nearest_view(views, 0.8, 0.9), &views[1]);
  EXPECT_EQ(&nearest_view(views, 0.1, 0.4), &views[2]);
  EXPECT_EQ(&nearest_view(views, 1.1, 0.3), &views[3]);
}

}  // namespace
}  // namespace heel
