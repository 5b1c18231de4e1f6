// Further pictures of the taught back, located by the template itself.
#pragma once

#include <string>
#include <vector>

#include "core/picture_turn.h"
#include "heel/shirt_template.h"

namespace heel::cli {

/// One for each image, all by the template's camera (`camera_file`), turned as the template's pictures.
/// Throws heel::Error naming the first image in which the shirt is not found, or not with certainty ≥ 0.1.
std::vector<FurtherView> further_views(const ShirtTemplate& shirt, const std::vector<std::string>& images,
                                       const std::string& camera_file, const PictureTurn& turn);

}  // namespace heel::cli
