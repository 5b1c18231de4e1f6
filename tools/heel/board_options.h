// The options that say which calibration board is shown: --board, --square and --pattern.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "board_finder.h"

namespace heel::cli {

struct BoardOptions {
  std::string board;  ///< "9x6"
  double square_m = 0.0;
  std::string pattern = "chessboard";
};

void add_board_options(CLI::App& command, BoardOptions& options, bool required);

/// Throws heel::Error naming the option.
Board board_of(const BoardOptions& options);

}  // namespace heel::cli
