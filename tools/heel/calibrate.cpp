// heel calibrate: chessboard views → camera_info YAML, with the error of every view.
//
// Z. Zhang, "A Flexible New Technique for Camera Calibration", PAMI 2000, as OpenCV carries it out.
#include <algorithm>
#include <cstdio>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "commands.h"
#include "files/camera_info.h"
#include "files/image_file.h"
#include "heel/camera_model.h"
#include "heel/error.h"

namespace heel::cli {
namespace {

constexpr std::size_t kMinViews = 5;
constexpr double kMaxViewRms_px = 1.5;  // a view worse than this has wrong corners, or a bent board
constexpr double kMinTurn_deg =
    20.0;  // between some two views: boards all parallel leave the focal length open
constexpr double kMaxFocalSigmaShare = 0.02;  // above: the views do not fix the focal length

struct CalibrateOptions {
  std::vector<std::string> images;
  std::string board;
  double square_m = 0.0;
  std::string output;
  bool k3 = false;
};

struct View {
  std::string image;
  std::vector<cv::Point2f> corners_px;
  double rms_px = 0.0;
};

struct Calibration {
  CameraModel camera;
  double rms_px = 0.0;
  double fx_sigma_px = 0.0;
  double fy_sigma_px = 0.0;
  double turn_deg = 0.0;  ///< the largest angle between the boards of two views
};

/// "9x6": inner corners along a row, and down a column.
cv::Size parse_board(const std::string& text) {
  int across = 0;
  int down = 0;
  int used = 0;
  if (std::sscanf(text.c_str(), "%3dx%3d%n", &across, &down, &used) != 2 ||
      used != static_cast<int>(text.size()) || across < 3 || down < 3) {
    throw Error("--board: '" + text + "' (expected inner corners across x down, each at least 3, e.g. 9x6)");
  }
  return {across, down};
}

std::vector<cv::Point2f> find_corners(const cv::Mat& grey, cv::Size board) {
  std::vector<cv::Point2f> corners_px;
  if (cv::findChessboardCornersSB(grey, board, corners_px, cv::CALIB_CB_ACCURACY)) return corners_px;
  // The older search finds boards with a narrow white margin, which the newer one needs.
  if (cv::findChessboardCorners(grey, board, corners_px)) {
    const cv::TermCriteria stop(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 50, 1e-3);
    cv::cornerSubPix(grey, corners_px, {5, 5}, {-1, -1}, stop);
    return corners_px;
  }
  return {};
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// The views in which the whole board is seen. Those in which it is not are named.
std::vector<View> find_views(const CalibrateOptions& options, cv::Size board, cv::Size& image_size) {
  std::vector<View> views;
  std::vector<std::string> without_board;
  for (const std::string& image : options.images) {
    const cv::Mat grey = read_grey_image(image);
    if (image_size.empty()) image_size = grey.size();
    if (grey.size() != image_size) {
      throw Error(image + ": " + std::to_string(grey.cols) + "x" + std::to_string(grey.rows) +
                  " pixels (expected " + std::to_string(image_size.width) + "x" +
                  std::to_string(image_size.height) + " as in " + options.images.front() + ")");
    }
    View view{image, find_corners(grey, board), 0.0};
    if (view.corners_px.empty()) {
      without_board.push_back(image);
    } else {
      views.push_back(std::move(view));
    }
  }
  if (views.size() < kMinViews) {
    throw Error("only " + std::to_string(views.size()) + " of " + std::to_string(options.images.size()) +
                " images show the whole " + options.board + " board (expected at least " +
                std::to_string(kMinViews) + ")" +
                (without_board.empty() ? "" : "; not seen in " + joined(without_board)));
  }
  for (const std::string& image : without_board)
    std::printf("%-40s no %s board\n", image.c_str(), options.board.c_str());
  return views;
}

std::vector<cv::Point3f> board_points(cv::Size board, double square_m) {
  std::vector<cv::Point3f> points_m;
  for (int row = 0; row < board.height; ++row) {
    for (int column = 0; column < board.width; ++column) {
      points_m.emplace_back(static_cast<float>(column * square_m), static_cast<float>(row * square_m), 0.f);
    }
  }
  return points_m;
}

double largest_turn_deg(const std::vector<cv::Mat>& rotations) {
  std::vector<cv::Vec3d> normals;
  for (const cv::Mat& rotation : rotations) {
    cv::Matx33d R;
    cv::Rodrigues(rotation, R);
    normals.push_back(R * cv::Vec3d(0, 0, 1));
  }
  double smallest_cosine = 1.0;
  for (const cv::Vec3d& a : normals) {
    for (const cv::Vec3d& b : normals) smallest_cosine = std::min(smallest_cosine, std::abs(a.dot(b)));
  }
  return std::acos(smallest_cosine) * 180.0 / CV_PI;
}

Calibration solve(std::vector<View>& views, cv::Size board, cv::Size image_size,
                  const CalibrateOptions& options) {
  std::vector<std::vector<cv::Point2f>> corners_px;
  for (const View& view : views) corners_px.push_back(view.corners_px);
  const std::vector<std::vector<cv::Point3f>> points_m(views.size(), board_points(board, options.square_m));

  cv::Mat K, distortion, intrinsic_sigmas, extrinsic_sigmas, view_rms_px;
  std::vector<cv::Mat> rotations, translations;
  Calibration result;
  result.rms_px =
      cv::calibrateCamera(points_m, corners_px, image_size, K, distortion, rotations, translations,
                          intrinsic_sigmas, extrinsic_sigmas, view_rms_px, options.k3 ? 0 : cv::CALIB_FIX_K3);
  for (std::size_t i = 0; i < views.size(); ++i)
    views[i].rms_px = view_rms_px.at<double>(static_cast<int>(i));
  result.turn_deg = largest_turn_deg(rotations);
  result.fx_sigma_px = intrinsic_sigmas.at<double>(0);
  result.fy_sigma_px = intrinsic_sigmas.at<double>(1);

  CameraModel& camera = result.camera;
  camera.width_px = image_size.width;
  camera.height_px = image_size.height;
  camera.fx = K.at<double>(0, 0);
  camera.fy = K.at<double>(1, 1);
  camera.cx = K.at<double>(0, 2);
  camera.cy = K.at<double>(1, 2);
  camera.k1 = distortion.at<double>(0);
  camera.k2 = distortion.at<double>(1);
  camera.p1 = distortion.at<double>(2);
  camera.p2 = distortion.at<double>(3);
  camera.k3 = distortion.at<double>(4);
  return result;
}

void refuse_poor_views(const std::vector<View>& views) {
  std::vector<std::string> poor;
  for (const View& view : views) {
    if (!(view.rms_px <= kMaxViewRms_px)) {
      char text[32];
      std::snprintf(text, sizeof text, " (%.2f px)", view.rms_px);
      poor.push_back(view.image + text);
    }
  }
  if (!poor.empty()) {
    throw Error("poor views, leave them out or take them again: " + joined(poor) + " (expected at most " +
                std::to_string(kMaxViewRms_px).substr(0, 3) + " px)");
  }
}

/// The solver's own sigma is not enough: from parallel boards it settles, sure of itself, on a wrong focal
/// length.
void refuse_unsure_focal_length(const Calibration& result) {
  char text[200];
  if (!(result.turn_deg >= kMinTurn_deg)) {
    std::snprintf(
        text, sizeof text,
        "the views do not fix the focal length: the board turns by %.0f degrees at most between them "
        "(expected %.0f or more; tilt it 30 to 45 degrees in several directions)",
        result.turn_deg, kMinTurn_deg);
    throw Error(text);
  }
  const double share = std::max(result.fx_sigma_px / result.camera.fx, result.fy_sigma_px / result.camera.fy);
  if (!(share <= kMaxFocalSigmaShare)) {
    std::snprintf(
        text, sizeof text,
        "the views do not fix the focal length: known to %.0f %% (expected %.0f %% or better; take more "
        "views, the board larger in the image)",
        100.0 * share, 100.0 * kMaxFocalSigmaShare);
    throw Error(text);
  }
}

void print_report(const std::vector<View>& views, const Calibration& result, const std::string& output) {
  for (const View& view : views) std::printf("%-40s %6.3f px\n", view.image.c_str(), view.rms_px);
  const CameraModel& camera = result.camera;
  std::printf("rms %.3f px over %zu views\n", result.rms_px, views.size());
  std::printf("fx %.2f ± %.2f  fy %.2f ± %.2f  cx %.2f  cy %.2f px\n", camera.fx, result.fx_sigma_px,
              camera.fy, result.fy_sigma_px, camera.cx, camera.cy);
  std::printf("k1 %.5f  k2 %.5f  p1 %.5f  p2 %.5f  k3 %.5f\n", camera.k1, camera.k2, camera.p1, camera.p2,
              camera.k3);
  std::printf("wrote %s\n", output.c_str());
}

void calibrate(const CalibrateOptions& options) {
  const cv::Size board = parse_board(options.board);
  cv::Size image_size;
  std::vector<View> views = find_views(options, board, image_size);
  const Calibration result = solve(views, board, image_size, options);
  refuse_poor_views(views);
  refuse_unsure_focal_length(result);
  write_camera_model(result.camera, options.output);
  print_report(views, result, options.output);
}

}  // namespace

void add_calibrate_command(CLI::App& app) {
  auto options = std::make_shared<CalibrateOptions>();
  CLI::App* command =
      app.add_subcommand("calibrate",
                         "Camera calibration from photographs of a chessboard; writes ROS camera_info YAML.\n"
                         "Take ten to twenty views at the resolution heel will use, the focus fixed, the "
                         "board filling much of the\n"
                         "image, in its corners too, tilted up to 45 degrees each way.");
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
  command->add_flag("--k3", options->k3, "also estimate the third radial coefficient (wide-angle lenses)");
  command->callback([options] { calibrate(*options); });
}

}  // namespace heel::cli
