// The options --rotate and --mirror, as the keys camera.rotate and camera.mirror.
#include "turn_options.h"

namespace heel::cli {

void add_turn_options(CLI::App& command, TurnOptions& options) {
  command
      .add_option(
          "--rotate", options.rotate,
          "turn each picture clockwise, so that it is upright (0 says that it is); the calibration\n"
          "stays that of the pictures as the camera sends them (default: camera.rotate of --config, else 0)")
      ->type_name("DEG")
      ->check(CLI::IsMember({0, 90, 180, 270}));
  command.add_flag("--mirror", options.mirror,
                   "mirror each picture left to right before it is turned (also with camera.mirror of "
                   "--config)");
}

PictureTurn turn_of(const TurnOptions& options, const CameraConfig& config) {
  return picture_turn(options.rotate.value_or(config.rotate), options.mirror || config.mirror);
}

}  // namespace heel::cli
