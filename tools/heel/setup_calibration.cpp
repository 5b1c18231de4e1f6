// heel setup: the camera is calibrated from live pictures of a board, or by a file that there is.
#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "board_collector.h"
#include "camera_calibration.h"
#include "camera_look.h"
#include "files/camera_info.h"
#include "files/orientation.h"
#include "heel/error.h"
#include "setup_steps.h"
#include "sharpest_picture.h"

namespace heel::cli {
namespace {

constexpr std::size_t kJudgedFrom = 8;   // views
constexpr std::size_t kJudgedEvery = 3;  // further views
constexpr std::size_t kEnough = 40;      // more views than these add nothing
constexpr TimeNs kLongest_ns = 600 * kNsPerS;

const char* advice_on_board(BoardSeen seen) {
  switch (seen) {
    case BoardSeen::None:
      return "no board seen: hold it into the picture, in good light";
    case BoardSeen::Moving:
      return "board seen: hold it still";
    case BoardSeen::Known:
      return "this view is there: move it to another part of the picture, or tilt it otherwise";
    case BoardSeen::Kept:
      break;
  }
  return "";
}

/// Collects views until they determine the camera.
class LiveCalibration {
 public:
  LiveCalibration(Setup& setup, const Board& board)
      : setup_(setup),
        board_(board),
        collector_(board),
        turn_(picture_turn(config().rotate, config().mirror)) {}

  /// Throws heel::Error when the views do not determine the camera.
  Calibration run() {
    CameraConfig as_sent = config();  // a calibration is of the pictures as the camera sends them
    as_sent.rotate = 0;
    as_sent.mirror = false;
    Look look(as_sent);
    look.take([&](const FrameView& frame) { add(grey_of(frame)); }, kLongest_ns, [&] { return goes_on(); });
    if (g_preflight_interrupted) throw SetupInterrupted();
    if (!good_ || judged_views_ < views()) judge();
    if (!good_) throw Error(problem_);
    return *good_;
  }
  std::size_t views() const { return collector_.views().size(); }

 private:
  const CameraConfig& config() const { return setup_.file.config().camera; }
  cv::Mat covered() const { return turned_picture(collector_.covered(), turn_); }

  bool goes_on() {
    const bool complete = good_ && warning_of(*good_).empty();
    return !complete && views() < kEnough && !setup_.dialogue.enter_pressed();
  }

  void add(const cv::Mat& grey) {
    const BoardSeen seen = collector_.add(grey);
    if (seen == BoardSeen::Kept) {
      say_view();
      const bool covers_all = parts_not_covered(covered()).empty();
      if (views() >= kJudgedFrom && (covers_all || (views() - kJudgedFrom) % kJudgedEvery == 0)) judge();
    } else if (seen != said_ && setup_.dialogue.at_terminal()) {
      setup_.dialogue.say(std::string("  ") + advice_on_board(seen));
    }
    said_ = seen;
  }

  void say_view() {
    const std::string missing = parts_not_covered(covered());
    const std::vector<std::string> lines = coverage_lines(covered());
    setup_.dialogue.say(fmt::format("  view {:<3} {}   {}", views(), lines[0],
                                    missing.empty() ? "every part is covered" : "not yet: " + missing));
    setup_.dialogue.say(fmt::format("           {}", lines[1]));
    setup_.dialogue.say(fmt::format("           {}", lines[2]));
  }

  void judge() {
    judged_views_ = views();
    good_.reset();
    if (views() < kMinViews) {
      problem_ = fmt::format("only {} views of the {}x{} board (expected at least {})", views(),
                             board_.corners.width, board_.corners.height, kMinViews);
      return;
    }
    try {
      std::vector<BoardView> judged = collector_.views();
      const Calibration result = calibrate_camera(board_, collector_.image_size(), /*with_k3=*/false, judged);
      require_good_calibration(judged, result);
      good_ = result;
      const std::string warning = warning_of(result);
      setup_.dialogue.say(fmt::format("  good: {:.2f} px over {} views{}", result.rms_px, views(),
                                      warning.empty() ? "" : "; still better: " + warning));
      if (!warning.empty() && setup_.dialogue.at_terminal())
        setup_.dialogue.say("  go on, or press Enter to take it as it is");
    } catch (const Error& error) {
      problem_ = error.what();
      setup_.dialogue.say("  not enough yet: " + problem_);
    }
  }

  Setup& setup_;
  Board board_;
  BoardCollector collector_;
  PictureTurn turn_;
  std::optional<Calibration> good_;
  std::size_t judged_views_ = 0;
  std::string problem_;
  std::optional<BoardSeen> said_;
};

/// Where a new calibration goes: the configured file, unless it is somebody's own in another folder.
std::string file_of_calibration(const Setup& setup) {
  const std::string& configured = setup.file.config().camera.info;
  const std::string beside = setup.file.beside(std::filesystem::path(configured).filename().string());
  std::error_code ignored;
  const bool is_elsewhere = std::filesystem::exists(configured, ignored) &&
                            !std::filesystem::equivalent(configured, beside, ignored);
  return is_elsewhere ? beside : configured;
}

PreflightStep live_calibration(Setup& setup, const Board& board) {
  PreflightStep step{.name = "calibration"};
  try {
    const std::string file = file_of_calibration(setup);
    require_folder_takes(file);
    setup.dialogue.say(
        "Move the board through the picture: near, into each corner, tilted 30 to 45 degrees each way; hold "
        "it "
        "still for a moment in each place.");
    LiveCalibration live(setup, board);
    const Calibration result = live.run();
    write_camera_model(result.camera, file);
    Config wanted = setup.file.config();
    wanted.camera.info = file;
    setup.file.write(wanted);
    step = check_calibration(setup.file.config());
    step.measured += fmt::format("; {:.2f} px over {} views", result.rms_px, live.views());
    step.values["rms_px"] = result.rms_px;
    step.values["views"] = live.views();
    step.values["warning"] = warnings_of(result);
    return step;
  } catch (const Error& error) {
    return step.fail(error.what(), advice_on(error.what(), "docs/inputs.md says how to take the views"));
  }
}

/// The calibration that the configuration names is one of the camera's pictures.
PreflightStep check_size(const Config& config) {
  PreflightStep step = check_calibration(config);
  if (step.verdict != StepVerdict::Pass) return step;
  if (step.values["width_px"] != config.camera.width_px ||
      step.values["height_px"] != config.camera.height_px)
    step.fail(step.measured, fmt::format("the camera sends {}x{} pixels: calibrate it in this size",
                                         config.camera.width_px, config.camera.height_px));
  return step;
}

PreflightStep take_file(Setup& setup, const std::string& camera_file) {
  Config wanted = setup.file.config();
  wanted.camera.info = std::filesystem::absolute(camera_file).lexically_normal().string();
  const PreflightStep step = check_size(wanted);
  if (step.verdict == StepVerdict::Pass) setup.file.write(wanted);
  return step;
}

/// "9x6" becomes a board; anything else is a file.
PreflightStep ask_for_board(Setup& setup) {
  std::optional<Board> board;
  std::string camera_file;
  const auto take = [&](const std::string& answer) -> std::string {
    if (std::filesystem::is_regular_file(answer)) {
      camera_file = answer;
      return "";
    }
    try {
      BoardOptions options = setup.options.board;
      options.board = answer;
      options.square_m = 1.0;  // is asked next
      board = board_of(options);
      return "";
    } catch (const Error&) {
      return "inner corners across x down, as 9x6, or a camera file that is there";
    }
  };
  setup.dialogue.ask_until(
      "The board's inner corners (where four squares meet), across x down; or the camera file that you have",
      "9x6", "--board or --camera-info", take);
  if (!camera_file.empty()) return take_file(setup, camera_file);
  board->square_m = setup.options.board.square_m;
  if (board->square_m == 0.0)
    setup.dialogue.ask_until("Side of one of its squares, metres", "0.025", "--square",
                             [&](const std::string& answer) -> std::string {
                               board->square_m = metres_in(answer, 1e-3, 1.0);
                               return board->square_m > 0.0 ? "" : "metres, 0.001 to 1";
                             });
  return live_calibration(setup, *board);
}

}  // namespace

PreflightStep set_up_calibration(Setup& setup) {
  const SetupOptions& options = setup.options;
  if (!options.camera_info.empty()) return take_file(setup, options.camera_info);
  if (!options.board.board.empty() && options.board.square_m > 0.0)
    return live_calibration(setup, board_of(options.board));
  if (!options.again("calibration") && std::filesystem::exists(setup.file.config().camera.info)) {
    const PreflightStep step = check_size(setup.file.config());
    if (step.verdict == StepVerdict::Pass &&
        setup.dialogue.yes(step.measured + ". Keep this calibration?", true, "--step calibration"))
      return step;
  }
  return ask_for_board(setup);
}

}  // namespace heel::cli
