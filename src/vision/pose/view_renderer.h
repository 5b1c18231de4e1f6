// Renders a view of the template: a picture of the back, turned or from farther away, from the reference
// picture.
//
// Units: pixels. Levels: 0 to 255.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/frame_view.h"
#include "heel/flow.h"
#include "heel/shirt_template.h"
#include "vision/pose/view_geometry.h"

namespace heel {

/// A picture of the view, and which place of the reference view each pixel shows.
struct RenderedView {
  int width_px = 0, height_px = 0;
  Eigen::Vector2d origin_px = Eigen::Vector2d::Zero();  ///< of the picture, in the view
  std::vector<std::uint8_t> grey;
  std::vector<std::optional<Eigen::Vector2d>> ref_px;

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px) + static_cast<std::size_t>(x);
  }
  FrameView frame() const { return packed_frame(grey.data(), width_px, height_px); }
};

/// `scale`: of the view's middle, view to reference. Beside the back each row has the level of the back's
/// edge.
RenderedView render_view(const ShirtTemplate& shirt, const ViewGeometry& geometry, double scale);

}  // namespace heel
