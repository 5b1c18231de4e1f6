// heel calibrate: views of a board → camera_info YAML, with the error of every view.
#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "board_images.h"
#include "board_options.h"
#include "camera_calibration.h"
#include "commandline/progress.h"
#include "commands.h"
#include "files/camera_info.h"
#include "files/image_file.h"
#include "heel/error.h"

namespace heel::cli {
namespace {

using CalibrationJson = nlohmann::ordered_json;

struct CalibrateOptions {
  std::vector<std::string> images;
  BoardOptions board;
  std::string output;
  bool with_k3 = false;
  bool json = false;
};

void print_searched(const SearchedImage& searched) {
  fmt::print("{:<40} {}  ({} of {})\n", searched.image,
             searched.is_part ? "found in part"
             : searched.found ? "found"
                              : "no board",
             searched.done, searched.images);
  std::fflush(stdout);
}

void print_report(const std::vector<BoardView>& views, const Calibration& result, const std::string& output) {
  for (const BoardView& view : views) fmt::print("{:<40} {:6.3f} px\n", view.image, view.rms_px);
  const CameraModel& camera = result.camera;
  fmt::print("rms {:.3f} px over {} views\n", result.rms_px, views.size());
  fmt::print("fx {:.2f} ± {:.2f}  fy {:.2f} ± {:.2f}  cx {:.2f}  cy {:.2f} px\n", camera.fx,
             result.fx_sigma_px, camera.fy, result.fy_sigma_px, camera.cx, camera.cy);
  const std::array<double, 3>& sigma = result.radial_sigma;
  fmt::print("k1 {:.5f} ± {:.5f}  k2 {:.5f} ± {:.5f}  p1 {:.5f}  p2 {:.5f}  k3 {:.5f} ± {:.5f}\n", camera.k1,
             sigma[0], camera.k2, sigma[1], camera.p1, camera.p2, camera.k3, sigma[2]);
  const EdgeErrors& edges = result.edges;
  fmt::print(
      "error of a direction, at 3 m (95 %): middle {:.1f} cm, left and right edge {:.1f} cm, corners {:.1f} "
      "cm\n",
      edges.centre_cm, edges.side_cm, edges.corner_cm);
  if (const std::string warning = warnings_of(result); !warning.empty()) fmt::print("warning: {}\n", warning);
  fmt::print("wrote {}\n", output);
}

CalibrationJson json_of(const BoardViews& found, const Calibration& result, const std::string& output) {
  const CameraModel& camera = result.camera;
  const std::array<double, 3>& sigma = result.radial_sigma;
  CalibrationJson json{{"output", output},
                       {"rms_px", result.rms_px},
                       {"width_px", camera.width_px},
                       {"height_px", camera.height_px},
                       {"fx", camera.fx},
                       {"fy", camera.fy},
                       {"cx", camera.cx},
                       {"cy", camera.cy},
                       {"fx_sigma_px", result.fx_sigma_px},
                       {"fy_sigma_px", result.fy_sigma_px},
                       {"distortion", {camera.k1, camera.k2, camera.p1, camera.p2, camera.k3}},
                       {"radial_sigma", {sigma[0], sigma[1], sigma[2]}},
                       {"direction_error_at_3_m_cm",
                        {{"middle", result.edges.centre_cm},
                         {"side", result.edges.side_cm},
                         {"corner", result.edges.corner_cm}}},
                       {"warning", warnings_of(result)},
                       {"views", CalibrationJson::array()},
                       {"images_without_board", found.images_without_board}};
  for (const BoardView& view : found.views)
    json["views"].push_back({{"image", view.image}, {"rms_px", view.rms_px}});
  return json;
}

void run_calibrate(const CalibrateOptions& options) {
  const Board board = board_of(options.board);
  const BoardImages pictures(options.images);
  for (const std::string& note : pictures.notes()) fmt::print(stderr, "heel calibrate: {}\n", note);
  for (const std::string& problem : pictures.problems()) fmt::print(stderr, "heel calibrate: {}\n", problem);
  const std::vector<std::string>& images = pictures.files();
  commandline::Progress progress("images searched", images.size());
  BoardViews found = find_board(images, board, kMinViews, [&](const SearchedImage& searched) {
    progress.clear();
    if (!options.json) print_searched(searched);
    if (!searched.missing.empty())
      fmt::print(stderr, "heel calibrate: {}: {}\n", searched.image, searched.missing);
    progress.show(searched.done);
  });
  progress.clear();
  const Calibration result = calibrate_camera(board, found.image_size, options.with_k3, found.views);
  require_good_calibration(found.views, result);
  write_camera_model(result.camera, options.output);
  if (options.json)
    fmt::print("{}\n", json_of(found, result, options.output).dump(2));
  else
    print_report(found.views, result, options.output);
}

}  // namespace

void add_calibrate_command(CLI::App& app) {
  auto options = std::make_shared<CalibrateOptions>();
  CLI::App* command = app.add_subcommand(
      "calibrate",
      "Camera calibration from photographs or videos of a board; writes ROS camera_info YAML.\n"
      "Take ten to twenty views at the resolution that heel will use, with fixed focus. The board\n"
      "should fill much of the image, reach its corners, and be tilted up to 45 degrees each way. A\n"
      "chessboard may be cut by the edge of the image, where two images or more show it as a whole.");
  command
      ->add_option(
          "images", options->images,
          "photographs of the board, folders of them, or videos, of which the sharpest frames\nare taken")
      ->required()
      ->type_name("IMAGES");
  add_board_options(*command, options->board, /*required=*/true);
  command->add_option("-o,--output", options->output, "camera file to write")
      ->required()
      ->type_name("CAM.yaml");
  command->add_flag("--k3", options->with_k3,
                    "also estimate the third radial coefficient (wide-angle lenses)");
  command->add_flag("--json", options->json, "one JSON object (default: text)");
  command->callback([options] { run_calibrate(*options); });
}

}  // namespace heel::cli
