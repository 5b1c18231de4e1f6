// heel calibrate: chessboard views → camera_info YAML, with the error of every view.
#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "camera_calibration.h"
#include "commands.h"
#include "files/camera_info.h"
#include "heel/error.h"

namespace heel::cli {
namespace {

struct CalibrateOptions {
  std::vector<std::string> images;
  std::string board;
  double square_m = 0.0;
  std::string output;
  bool with_k3 = false;
};

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

void print_report(const std::vector<BoardView>& views, const Calibration& result, const std::string& output) {
  for (const BoardView& view : views) fmt::print("{:<40} {:6.3f} px\n", view.image, view.rms_px);
  const CameraModel& camera = result.camera;
  fmt::print("rms {:.3f} px over {} views\n", result.rms_px, views.size());
  fmt::print("fx {:.2f} ± {:.2f}  fy {:.2f} ± {:.2f}  cx {:.2f}  cy {:.2f} px\n", camera.fx,
             result.fx_sigma_px, camera.fy, result.fy_sigma_px, camera.cx, camera.cy);
  fmt::print("k1 {:.5f}  k2 {:.5f}  p1 {:.5f}  p2 {:.5f}  k3 {:.5f}\n", camera.k1, camera.k2, camera.p1,
             camera.p2, camera.k3);
  fmt::print("wrote {}\n", output);
}

void run_calibrate(const CalibrateOptions& options) {
  const Board board{parse_corners(options.board), options.square_m};
  BoardViews found = find_board(options.images, board);
  for (const std::string& image : found.images_without_board)
    fmt::print("{:<40} no {} board\n", image, options.board);
  const Calibration result = calibrate_camera(board, found.image_size, options.with_k3, found.views);
  require_good_calibration(found.views, result);
  write_camera_model(result.camera, options.output);
  print_report(found.views, result, options.output);
}

}  // namespace

void add_calibrate_command(CLI::App& app) {
  auto options = std::make_shared<CalibrateOptions>();
  CLI::App* command = app.add_subcommand(
      "calibrate",
      "Camera calibration from photographs of a chessboard; writes ROS camera_info YAML.\n"
      "Take ten to twenty views at the resolution that heel will use, with fixed focus. The board\n"
      "should fill much of the image, reach its corners, and be tilted up to 45 degrees each way.");
  command->add_option("images", options->images, "photographs of the board")->required()->type_name("IMAGES");
  command->add_option("--board", options->board, "inner corners, across x down, e.g. 9x6")
      ->required()
      ->type_name("CxR");
  command->add_option("--square", options->square_m, "side of one square, metres")
      ->required()
      ->type_name("M")
      ->check(number_from(1e-4, 10.0));
  command->add_option("-o,--output", options->output, "camera file to write")
      ->required()
      ->type_name("CAM.yaml");
  command->add_flag("--k3", options->with_k3,
                    "also estimate the third radial coefficient (wide-angle lenses)");
  command->callback([options] { run_calibrate(*options); });
}

}  // namespace heel::cli
