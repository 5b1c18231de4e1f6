// Pictures of a camera that is mounted turned or mirrored, for commands that read them from files.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>

#include "core/config.h"
#include "core/picture_turn.h"

namespace heel::cli {

struct TurnOptions {
  std::optional<int> rotate;  ///< degrees clockwise
  bool mirror = false;
};

/// Adds --rotate and --mirror.
void add_turn_options(CLI::App& command, TurnOptions& options);

/// What the options say, and the configuration where they say nothing.
PictureTurn turn_of(const TurnOptions& options, const CameraConfig& config = {});

}  // namespace heel::cli
