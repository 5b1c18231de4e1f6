#include "board_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "files/folder.h"
#include "files/frame_input.h"
#include "files/image_file.h"
#include "heel/error.h"
#include "sharpness.h"

namespace heel::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kRate_hz = 30.0;             // of images, whose times do not matter here
constexpr std::uint64_t kPartOfUnknown = 15;  // frames, of a video that does not say how many it has

}  // namespace

BoardImages::BoardImages(const std::vector<std::string>& inputs) {
  for (const std::string& input : inputs) {
    if (fs::is_directory(input)) {
      add_folder(input);
    } else if (is_image_file(input)) {
      files_.push_back(input);
    } else {
      add_video(input);
    }
  }
}

BoardImages::~BoardImages() {
  std::error_code ignored;
  if (!folder_.empty()) fs::remove_all(folder_, ignored);
}

void BoardImages::add_folder(const std::string& folder) {
  const std::vector<std::string> inside = images_of_folder(folder, notes_);
  files_.insert(files_.end(), inside.begin(), inside.end());
}

/// Its frames have the video's name before their numbers, so that the lines about them say where they are
/// from.
std::string BoardImages::new_folder_for(const std::string& video) {
  if (folder_.empty()) {
    std::string name = (fs::temp_directory_path() / "heel-calibrate-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw Error(name + ": cannot make such a folder");
    folder_ = name;
  }
  std::string folder = fmt::format("{}/{}/{}", folder_, files_.size(), fs::path(video).filename().string());
  fs::create_directories(folder);
  return folder;
}

void BoardImages::add_video(const std::string& video) {
  FrameInput input({video}, kRate_hz);
  const std::string folder = new_folder_for(video);
  const std::uint64_t stated = input.stated_frame_count();
  const std::uint64_t part = stated == 0
                                 ? kPartOfUnknown
                                 : std::max<std::uint64_t>(1, (stated + kFramesOfVideo - 1) / kFramesOfVideo);
  InputFrame frame, best;
  double sharpest = -1.0;
  const auto keep_best = [&] {
    if (sharpest < 0.0) return;
    files_.push_back(fmt::format("{}/{:05}.png", folder, best.number));
    write_grey_image(files_.back(), best.grey.data, best.grey.cols, best.grey.rows);
    sharpest = -1.0;
  };
  while (input.next(frame)) {
    if (frame.number % part == 0) keep_best();
    const double sharpness = sharpness_of(frame.grey);
    if (sharpness <= sharpest) continue;
    sharpest = sharpness;
    best = frame;
    best.grey = frame.grey.clone();
  }
  keep_best();
  problems_.insert(problems_.end(), input.problems().begin(), input.problems().end());
  notes_.insert(notes_.end(), input.notes().begin(), input.notes().end());
}

}  // namespace heel::cli
