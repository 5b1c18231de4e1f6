#include "sim/render/jpeg_round_trip.h"

#include <string>

#include "core/frame_view.h"
#include "files/grey_encoder.h"
#include "files/jpeg_decoder.h"
#include "heel/error.h"

namespace heel::sim {

void jpeg_round_trip(std::vector<std::uint8_t>& grey, int width_px, int height_px, int quality) {
  const std::string jpeg = jpeg_of_grey(packed_frame(grey.data(), width_px, height_px), quality);
  JpegDecoder decoder;
  if (!decoder.decode(reinterpret_cast<const std::uint8_t*>(jpeg.data()), jpeg.size(),
                      static_cast<std::uint32_t>(width_px), static_cast<std::uint32_t>(height_px),
                      grey.data()))
    throw Error(std::string("simulated Motion-JPEG: ") + decoder.problem());
}

}  // namespace heel::sim
