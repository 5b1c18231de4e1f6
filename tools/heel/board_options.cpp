#include "board_options.h"

#include <cstdio>

#include "commands.h"
#include "heel/error.h"

namespace heel::cli {
namespace {

/// "9x6": inner corners along a row, and down a column.
cv::Size parse_corners(const std::string& text) {
  int across = 0;
  int down = 0;
  int used = 0;
  if (std::sscanf(text.c_str(), "%3dx%3d%n", &across, &down, &used) != 2 ||
      used != static_cast<int>(text.size()) || across < 3 || down < 3) {
    throw Error("--board: '" + text + "' (expected inner corners across x down, each at least 3, e.g. 9x6)");
  }
  return {across, down};
}

Pattern parse_pattern(const std::string& name) {
  if (name == "chessboard") return Pattern::Chessboard;
  if (name == "charuco") return Pattern::Charuco;
  if (name == "circles") return Pattern::Circles;
  if (name == "asymmetric-circles") return Pattern::AsymmetricCircles;
  throw Error("--pattern: '" + name + "' (expected chessboard, charuco, circles or asymmetric-circles)");
}

}  // namespace

void add_board_options(CLI::App& command, BoardOptions& options, bool required) {
  command
      .add_option("--board", options.board,
                  "inner corners (where four squares meet), across x down, e.g. 9x6 for 10x7 squares;\n"
                  "of a grid of circles: circles in a row x rows")
      ->required(required)
      ->type_name("CxR");
  command
      .add_option("--square", options.square_m,
                  "side of one square, or from one circle to the next, metres; of asymmetric\n"
                  "circles: half the distance of two circles of a row")
      ->required(required)
      ->type_name("M")
      ->check(metres_from(1e-4, 10.0));
  command
      .add_option("--pattern", options.pattern,
                  "chessboard (default), charuco (a chessboard with markers), circles or asymmetric-circles")
      ->type_name("KIND");
}

Board board_of(const BoardOptions& options) {
  const Board board{parse_corners(options.board), options.square_m, parse_pattern(options.pattern)};
  if (board.pattern == Pattern::AsymmetricCircles && board.corners.height % 2 == 0)
    throw Error("--board: '" + options.board +
                "' (expected an odd number of rows of asymmetric circles, e.g. 4x11: an even one "
                "looks the same upside down)");
  return board;
}

}  // namespace heel::cli
