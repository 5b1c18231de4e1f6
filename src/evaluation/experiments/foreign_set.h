// A set of pictures of people in printed T-shirts, from behind, with truth, made without any part of heel:
// bodies, cloth, walks, prints and renderer of others. FOLDER/images, FOLDER/truth.csv, FOLDER/camera.yaml.
// The sets are not part of heel (HEEL_TEST_DATA).
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "heel/shirt_template.h"

namespace heel::evaluation {

/// A row of truth.csv. Angles relative to the taught picture, in the camera frame; positive: to the image's
/// right.
struct ForeignPicture {
  std::string image, path;
  std::string kind;          ///< teach, static, calm, rigid (the taught cloth), board, walk
  std::string build, print;  ///< whose body, which print: together they name the template
  std::string pose, room;
  double t_s = 0.0;         ///< of a frame of a walk
  double distance_m = 0.0;  ///< as set
  double yaw_set_deg = 0.0;
  double yaw_back_deg = 0.0;          ///< the truth: rotation of the back's cloth, best rigid fit
  double yaw_walk_deg = 0.0;          ///< of the path in a walk
  double cloth_moved_mm = 0.0;        ///< RMS along the normal since teaching
  Eigen::Vector3d centre_m{0, 0, 0};  ///< what the centre of the taught region shows, camera frame
  Region roi;                         ///< with teach_distance_m: what `heel teach` is told
  double teach_distance_m = 0.0;

  bool is_taught() const;  ///< a template is made of it
  bool is_person() const;  ///< a single picture of a person: static, calm or rigid
  bool is_in_walk() const { return kind == "walk"; }
};

/// Body and print.
using ShirtName = std::pair<std::string, std::string>;
inline ShirtName shirt_of(const ForeignPicture& picture) {
  return {picture.build, picture.print};
}

struct ForeignSet {
  CameraModel camera;
  std::vector<ForeignPicture> pictures;
};

/// Throws heel::Error naming what is missing or wrong.
ForeignSet read_foreign_set(const std::string& folder);

struct ForeignTemplates {
  std::map<ShirtName, ShirtTemplate> usable;
  std::map<ShirtName, std::string> refused;  ///< and why
};

/// One template for each body and print, by the same checks as `heel teach`.
ForeignTemplates teach_foreign_set(const ForeignSet& set);

}  // namespace heel::evaluation
