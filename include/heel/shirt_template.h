// The template: the reference view of the shirt, its region, its distance and its camera, in one file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "heel/camera_model.h"
#include "heel/features.h"

namespace heel {

/// What a .heel file holds. Features are computed anew from the image when it is loaded, so that they always
/// come from the same code as the frame's.
struct ShirtTemplate {
  std::vector<std::uint8_t>
      grey;  ///< the whole reference image, row-major, camera.width_px × camera.height_px
  CameraModel camera;
  Region roi;               ///< the back of the shirt
  double distance_m = 0.0;  ///< camera to the back along z; 0: not known
  bool oriented = false;    ///< use oriented descriptors (default upright)
  int max_features = 300;   ///< template features kept
};

/// The features of the template's region (sigma over a wide range), strongest first.
FeatureSet template_features(const ShirtTemplate& shirt);

/// How well a template can be followed, and why.
struct TemplateVerdict {
  bool usable = false;
  std::string reason;  ///< one line when not usable
  int features = 0;
  double spread = 0.0;  ///< 0…1: share of a 4 × 4 grid over the region that holds a feature
  double self_similarity =
      0.0;                    ///< share of features whose nearest other feature fails the ratio test's margin
  double coarse_share = 0.0;  ///< share of features that survive at twice the distance
};
TemplateVerdict judge_template(const ShirtTemplate& shirt);

}  // namespace heel
