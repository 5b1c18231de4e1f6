#include "evaluation/experiments/back_set_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <tuple>

#include "core/angles.h"
#include "core/random.h"

namespace heel::evaluation {
namespace {

constexpr std::array kPrints{"shapes", "emblem", "photo", "text"};
constexpr std::array kRooms{"lamps", "sun"};

/// A posture unlike the taught one: lean up to 7 degrees, twist up to 5.
sim::Posture standing(std::uint64_t settling, Random& random) {
  sim::Posture posture;
  posture.settling = settling;
  posture.lean_rad = kRadPerDeg * random.uniform(-2.0, 5.0);
  posture.roll_rad = kRadPerDeg * random.uniform(-2.5, 2.5);
  posture.turn_rad = kRadPerDeg * random.uniform(-1.0, 1.0);
  posture.twist_rad = kRadPerDeg * random.uniform(-5.0, 5.0);
  return posture;
}

class Plan {
 public:
  explicit Plan(std::uint64_t seed) : random_(derived_seed(seed, 0xbac)) {}

  void add_taught() {
    for (const BackBuild& build : back_set_builds())
      for (const char* print : kPrints) {
        BackPicture picture = of("teach", build.name, print, "teach", kRooms[0], kBackSetTeach_m, 0.0);
        picture.image = fmt::format("teach_{}_{}.png", build.name, print);
        picture.bearing_deg = 0.0;
        picture.posture = sim::kTaughtPosture;
        pictures_.push_back(picture);
      }
  }

  /// Persons who stand otherwise than when they were taught.
  void add_static() {
    constexpr std::array kDistances_m{1.0, 1.5, 2.0, 2.5, 3.0, 4.0};
    std::size_t turn = 0;
    for (const double distance_m : kDistances_m)
      for (int yaw = -60; yaw <= 60; yaw += 15, ++turn)
        for (std::size_t b = 0; b < back_set_builds().size(); ++b) {
          const std::string& build = back_set_builds()[b].name;
          const char* print = kPrints[(turn + b) % kPrints.size()];
          const std::uint64_t settling = next_settling();
          BackPicture picture = of("static", build, print, fmt::format("s{}", settling), any_room(),
                                   distance_m, yaw == 0 ? 0.0 : yaw + random_.uniform(-3.0, 3.0));
          picture.image = fmt::format("s_{:02.0f}_{:+03}_{}_{}.png", 10 * distance_m, yaw, build, print);
          picture.posture = standing(settling, random_);
          pictures_.push_back(picture);
        }
  }

  /// The taught posture, with the cloth settled otherwise (calm) or as taught (rigid).
  void add_posture_of_taught(const char* kind) {
    const bool rigid = kind == std::string("rigid");
    std::size_t turn = 0;
    for (const double distance_m : {1.5, 2.0, 3.0})
      for (int yaw = -40; yaw <= 40; yaw += 20, ++turn)
        for (std::size_t b = 0; b < back_set_builds().size(); ++b) {
          const std::string& build = back_set_builds()[b].name;
          const char* print = kPrints[(turn + 2 * b + (rigid ? 1 : 0)) % kPrints.size()];
          const std::uint64_t settling = rigid ? 0 : next_settling();
          BackPicture picture = of(kind, build, print, rigid ? "teach" : fmt::format("c{}", settling),
                                   any_room(), distance_m, yaw == 0 ? 0.0 : yaw + random_.uniform(-3.0, 3.0));
          picture.image =
              fmt::format("{}_{:02.0f}_{:+03}_{}_{}.png", kind[0], 10 * distance_m, yaw, build, print);
          picture.posture = sim::kTaughtPosture;
          picture.posture.settling = settling;
          pictures_.push_back(picture);
        }
  }

  void add_board() {
    for (const char* print : {"shapes", "photo"}) {
      int index = 0;
      for (const auto& [distance_m, yaw_deg] : {std::tuple{1.5, 0.0},
                                                {1.5, 20.0},
                                                {1.2, -40.0},
                                                {2.5, -20.0},
                                                {2.0, 0.0},
                                                {2.0, 45.0},
                                                {1.5, 60.0}}) {
        BackPicture picture = of("board", kBoardBuild, print, "-", kRooms[0], distance_m, yaw_deg);
        picture.image = index == 0 ? fmt::format("board_{}_teach.png", print)
                                   : fmt::format("board_{}_{}.png", print, index);
        if (index == 0) picture.bearing_deg = 0.0;
        picture.posture = sim::kTaughtPosture;
        pictures_.push_back(picture);
        ++index;
      }
    }
  }

  std::vector<BackPicture> by_world() {
    std::stable_sort(pictures_.begin(), pictures_.end(), [](const BackPicture& a, const BackPicture& b) {
      return std::tie(a.build, a.print, a.room) < std::tie(b.build, b.print, b.room);
    });
    return std::move(pictures_);
  }

 private:
  BackPicture of(const char* kind, const std::string& build, const char* print, const std::string& pose,
                 const char* room, double distance_m, double yaw_deg) {
    BackPicture picture;
    picture.kind = kind;
    picture.build = build;
    picture.print = print;
    picture.pose = pose;
    picture.room = room;
    picture.distance_m = distance_m;
    picture.yaw_deg = yaw_deg;
    picture.bearing_deg = random_.uniform(-10.0, 10.0);
    picture.heading_rad = random_.uniform(-std::numbers::pi, std::numbers::pi);
    return picture;
  }
  const char* any_room() { return kRooms[static_cast<std::size_t>(random_.index(2))]; }
  std::uint64_t next_settling() { return ++settling_; }

  Random random_;
  std::uint64_t settling_ = 0;
  std::vector<BackPicture> pictures_;
};

}  // namespace

const std::vector<BackBuild>& back_set_builds() {
  static const std::vector<BackBuild> kBuilds{{"average", 1.0}, {"deep", 1.25}, {"flat", 0.8}};
  return kBuilds;
}

std::vector<BackPicture> back_set_stills(std::uint64_t seed) {
  Plan plan(seed);
  plan.add_taught();
  plan.add_static();
  plan.add_posture_of_taught("calm");
  plan.add_posture_of_taught("rigid");
  plan.add_board();
  return plan.by_world();
}

}  // namespace heel::evaluation
