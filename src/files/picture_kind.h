// What a file is that has a picture's name, or stands beside pictures, by its first bytes.
#pragma once

#include <string>

#include "files/byte_view.h"

namespace heel {

inline constexpr std::size_t kPictureKindBytes = 32;  ///< of a file's beginning are enough

/// "a HEIC" for a picture of a kind that heel does not read, whatever its name's ending; empty for kinds that
/// it reads, and unknown ones.
std::string unreadable_picture_kind(ByteView file);

/// "a PNG" for a picture of a kind that heel reads; empty for others.
std::string readable_picture_kind(ByteView file);

/// "an AVI" for a video; empty for others, and for videos without a beginning of their own.
std::string video_kind(ByteView file);

}  // namespace heel
