// The body: proportions, gait, sitting, breath, and cloth that slides over it.
#include "sim/scene/person.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "heel/error.h"

namespace heel::sim {
namespace {

/// Lowest and highest point of a part in the world.
std::pair<double, double> heights(const Person& person, const PersonPose& pose, PersonPart part) {
  double low = 1e9, high = -1e9;
  for (const MeshVertex& vertex : person.mesh(part).vertices) {
    const double z = (pose.world_from_part[part] * vertex.position_m.cast<double>()).z();
    low = std::min(low, z);
    high = std::max(high, z);
  }
  return {low, high};
}

Person someone(PersonSettings settings = {}) {
  return Person(settings, 1, 2);
}

TEST(Person, StandsOnTheFloorUpToTheirHeight) {
  const Person person = someone();
  const PersonPose pose = person.pose({}, 0.0);
  EXPECT_NEAR(heights(person, pose, kLeftShin).first, 0.0, 0.01);
  EXPECT_NEAR(heights(person, pose, kRightShin).first, 0.0, 0.01);
  EXPECT_NEAR(heights(person, pose, kHead).second, 1.775, 0.02);
  EXPECT_LT(heights(person, pose, kHead).second, kPersonHeight_m);
  // Shoulders are wider than the waist.
  double shoulders = 0, waist = 0;
  for (const MeshVertex& vertex : person.mesh(kTorso).vertices) {
    if (std::abs(vertex.position_m.z() - 0.47f) < 0.02f)
      shoulders = std::max(shoulders, static_cast<double>(vertex.position_m.y()));
    if (std::abs(vertex.position_m.z() - 0.14f) < 0.02f)
      waist = std::max(waist, static_cast<double>(vertex.position_m.y()));
  }
  EXPECT_GT(shoulders, waist + 0.02);
}

TEST(Person, FeetStayAboutTheFloorInEveryGait) {
  const Person person = someone();
  for (const double travel : {0.0, 1.5708, -1.5708, 3.1416})
    for (double stride = 0; stride < 6.3; stride += 0.3) {
      WalkState walk;
      walk.speed_m_s = 0.6;
      walk.travel_rad = travel;
      walk.stride_rad = stride;
      const PersonPose pose = person.pose(walk, 1.0);
      const double left = heights(person, pose, kLeftShin).first;
      const double right = heights(person, pose, kRightShin).first;
      EXPECT_GT(std::min(left, right), -0.06) << travel << ' ' << stride;
      EXPECT_LT(std::min(left, right), 0.09) << travel << ' ' << stride;
    }
}

TEST(Person, SwayStaysWithinTheSetting) {
  const Person person = someone();
  double most = 0;
  for (double stride = 0; stride < 6.3; stride += 0.05) {
    WalkState walk;
    walk.speed_m_s = 0.6;
    walk.stride_rad = stride;
    const Eigen::Vector3d forwards = person.pose(walk, 0.0).world_from_part[kTorso].linear().col(0);
    most = std::max(most, std::abs(std::atan2(forwards.y(), forwards.x())));
  }
  EXPECT_NEAR(most, PersonSettings{}.sway_yaw_rad, 0.005);
  EXPECT_LT(most, 0.1746);  // the paper's 10 degrees
}

TEST(Person, HipsTurnAgainstTheChest) {
  const Person person = someone();
  double most = 0;
  for (double stride = 0; stride < 6.3; stride += 0.05) {
    WalkState walk;
    walk.speed_m_s = 0.6;
    walk.stride_rad = stride;
    const PersonPose pose = person.pose(walk, 0.0);
    const Eigen::Vector3d chest = pose.world_from_part[kTorso].linear().col(0);
    const double hips_rad = std::atan2(pose.hips_forwards.y(), pose.hips_forwards.x());
    EXPECT_LE(hips_rad * std::atan2(chest.y(), chest.x()), 1e-6) << stride;
    most = std::max(most, std::abs(hips_rad));
  }
  EXPECT_NEAR(most, PersonSettings{}.hips_yaw_rad, 0.005);
}

TEST(Person, APostureLeansTurnsAndFoldsTheShirt) {
  const Person person = someone();
  Posture bent;
  bent.lean_rad = 0.1;
  bent.turn_rad = 0.05;
  const PersonPose upright = person.pose({}, 0.0), pose = person.pose({}, 0.0, bent);
  const Eigen::Vector3d forwards = pose.world_from_part[kTorso].linear().col(0);
  EXPECT_NEAR(std::atan2(forwards.y(), forwards.x()), 0.05, 1e-9);
  EXPECT_NEAR(-forwards.z(), std::sin(0.1), 1e-9);
  EXPECT_GT(pose.cloth.pull_m, upright.cloth.pull_m + 0.005);
  EXPECT_NE(upright.cloth.settling, person.pose({}, 0.0, kTaughtPosture).cloth.settling);
}

TEST(Person, SeatedHipsAreOverTheStool) {
  const Person person = someone();
  WalkState walk;
  walk.seat = 1.0;
  const PersonPose pose = person.pose(walk, 0.0);
  const Eigen::Vector3d hips = pose.world_from_part[kTorso].translation();
  EXPECT_NEAR(hips.x(), -kSeatBehindFeet_m, 1e-9);
  EXPECT_NEAR(heights(person, pose, kTorso).first, kStoolHeight_m, 0.04);
  EXPECT_NEAR(heights(person, pose, kLeftShin).first, 0.0, 0.06);
}

TEST(Person, BreathMovesTheBackAndNothingElse) {
  PersonSettings settings;
  settings.cloth_fold_m = 0.0;
  settings.breath_m = 0.005;
  const Person person = someone(settings);
  const PersonPose out = person.pose({}, 0.0);
  const PersonPose in = person.pose({}, 2.0);  // half a breath later
  const Eigen::Vector3d before = person.shirt_point_m(512, 260, out.cloth);
  const Eigen::Vector3d after = person.shirt_point_m(512, 260, in.cloth);
  EXPECT_NEAR(before.x() - after.x(), 0.005, 0.0005);  // backwards
  EXPECT_LT((person.shirt_point_m(512, 690, out.cloth) - person.shirt_point_m(512, 690, in.cloth)).norm(),
            0.001);
}

TEST(Person, SlidingClothCarriesThePrintAndKeepsToTheBody) {
  const Person person = someone();
  ClothState cloth;
  cloth.slide_around_m = 0.010;
  cloth.slide_up_m = 0.006;
  const Eigen::Vector3d rest = person.shirt_point_m(512, 300);
  const Eigen::Vector3d slid = person.shirt_point_m(512, 300, cloth);
  EXPECT_NEAR(slid.y() - rest.y(), -0.010, 0.0005);  // to the right
  EXPECT_NEAR(slid.z() - rest.z(), 0.006, 0.0005);
  EXPECT_NEAR(slid.x(), rest.x(), 0.002);  // still on the back
  // The collar holds.
  EXPECT_LT((person.shirt_point_m(512, 5, cloth) - person.shirt_point_m(512, 5)).norm(), 0.001);
}

TEST(Person, LongHairCoversTheShoulderBlades) {
  PersonSettings settings;
  settings.hair = Hair::Long;
  const Person person = someone(settings);
  const PersonPose pose = person.pose({}, 0.0);
  const auto [low, high] = heights(person, pose, kHair);
  EXPECT_LT(low, 0.92 + 0.40);
  EXPECT_GT(high, 1.7);
  double rearmost = 0;
  for (const MeshVertex& vertex : person.mesh(kHair).vertices)
    rearmost = std::min(rearmost, (pose.world_from_part[kHair] * vertex.position_m.cast<double>()).x());
  EXPECT_LT(rearmost, person.back_centre_m().x());  // before the shirt, seen from behind
  EXPECT_THROW(hair_style("mohawk"), Error);
}

}  // namespace
}  // namespace heel::sim
