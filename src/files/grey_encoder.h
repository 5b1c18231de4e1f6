// Grey pictures as PNG and JPEG files in memory, by libpng and libjpeg-turbo alone: heeld writes pictures
// without OpenCV, whose reader of pictures brings a hundred libraries.
#pragma once

#include <string>

#include "heel/flow.h"

namespace heel {

/// Of a picture of at least one pixel. Throws heel::Error when the library refuses it.
std::string png_of_grey(const FrameView& grey);
/// `quality`: 1…100.
std::string jpeg_of_grey(const FrameView& grey, int quality);

}  // namespace heel
