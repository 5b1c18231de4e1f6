// Video files made by FFmpeg's libraries, with time stamps and a display matrix of the test's choice.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

namespace heel::test {

struct MadeVideo {
  std::string path;  ///< its ending says which container: .mp4, .mkv, .avi …
  std::vector<cv::Mat> greys;
  std::vector<double> times_s;       ///< one of each frame
  int b_frames = 0;                  ///< between two others: the frames are then stored in another order
  std::vector<double> display_abcd;  ///< the display matrix's a, b, c, d; empty: none
  int ticks_per_s = 1000;            ///< of its clock; of AVI files: the frame rate
  double last_shown_s = 0.0;         ///< how long the last frame is shown; 0: as long as the one before it
  bool index_first = false;          ///< of an MP4 file, so that it can be read when its end is missing
  bool interlaced = false;           ///< its frames say that they are two fields, row by row
  bool header_interlaced = false;    ///< its header says so
  bool jpeg = false;                 ///< Motion-JPEG, whose frames cannot say so
  bool jpeg_fields = false;  ///< with jpeg: each packet has two pictures, of the even and the odd rows
  const char* raw_format = nullptr;  ///< FFmpeg's pixel format of black frames, not coded; null: MPEG-4
};

/// Video of nearly these pictures (with raw_format: of black ones of their size), whose sides must be
/// multiples of 16. Throws std::runtime_error.
void write_video(const MadeVideo& video);

/// The first `share` of the file.
void cut_file(const std::string& path, double share);

}  // namespace heel::test
