// Pictures of a recording: grey frames as JPEG or PNG, and as foxglove.CompressedImage in JSON.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "heel/flow.h"

namespace heel {

struct RecordedPicture {
  FrameHeader header;
  std::string format;  ///< "jpeg" or "png"
  std::string bytes;   ///< of the file
};

/// Throws heel::Error when the picture cannot be compressed.
RecordedPicture compressed_picture(const FrameView& frame, bool lossless);
/// Row-major grey without gaps. Throws heel::Error when it is no picture of the header's size.
std::vector<std::uint8_t> picture_pixels(const RecordedPicture& picture);

/// foxglove.CompressedImage, with the frame's number, its time and its size beside.
void append_picture_json(std::string& json, const RecordedPicture& picture, TimeNs t_log_ns);
/// Throws heel::Error for a text that is none.
RecordedPicture picture_from_json(std::string_view json);
std::string picture_json_schema();

}  // namespace heel
