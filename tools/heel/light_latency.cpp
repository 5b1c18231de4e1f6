#include "light_latency.h"

#include <memory>
#include <optional>

#include "capture/factory/frame_source_factory.h"
#include "capture/frame_source.h"
#include "commandline/progress.h"
#include "core/picture_turn.h"
#include "core/random.h"
#include "evaluation/metrics/light_response.h"
#include "evaluation/metrics/samples.h"
#include "files/camera_info.h"
#include "files/template_file.h"
#include "heel/error.h"
#include "lamp.h"
#include "preflight_step.h"
#include "realtime/clock.h"
#include "robot/robot_address.h"
#include "vision/pose/template_selector.h"
#include "vision/template/turned_template.h"

namespace heel::cli {
namespace {

using evaluation::LightFrame;
using evaluation::LightSwitch;

constexpr TimeNs kFirstFrame_ns = 16 * kNsPerS;  // as patient as heeld is with a camera that was never heard
constexpr TimeNs kNoFrame_ns = 2 * kNsPerS;
// Switching at random moments meets every phase of the camera's frames. Automatic exposure settles meanwhile.
constexpr double kShortest_s = 0.5, kLongest_s = 0.9;
constexpr double kCommandBits = 2 * 9 * 10;  // VEL and RVEL, with start and stop bits

/// The stage that heeld runs, where the configuration's files are there.
class MeasuredVision {
 public:
  explicit MeasuredVision(const Config& config) {
    try {
      const CameraModel camera = read_camera_model(config.camera.info);
      const PictureTurn turn = picture_turn(config.camera.rotate, config.camera.mirror);
      const std::vector<ShirtTemplate> shirts =
          templates_for_turned(read_templates(config.target), camera, turn).shirts;
      stage_.emplace(shirts, turned_camera(camera, turn), config.vision);
    } catch (const Error& error) {
      missing_ = error.what();
    }
  }

  void see(const FrameView& frame) {
    if (!stage_ || stage_->estimate(frame).reason != PoseReason::WrongFrameSize) return;
    stage_.reset();
    missing_ = "camera.info is of pictures of another size";
  }
  /// Empty: nothing is.
  const std::string& missing() const { return missing_; }

 private:
  std::optional<TemplateSelector> stage_;
  std::string missing_;
};

struct Watched {
  std::vector<LightFrame> frames;
  std::vector<TimeNs> t_done_ns;  // of each frame: when vision had finished
  std::vector<LightSwitch> switches;
};

/// Not a Look, which does something between two frames only: the light must meet every phase of them.
class LightWatch {
 public:
  LightWatch(const Config& config, Lamp& lamp)
      : source_(open_frame_source(config.camera)), vision_(config), lamp_(lamp) {}

  /// The light is switched from this thread, between two frames, so a frame that comes meanwhile is not late.
  Watched run(int switches, bool show_progress) {
    lamp_.set(false);
    wait_for_first_frame();
    Random random(static_cast<std::uint64_t>(monotonic_now_ns()));
    const auto pause_ns = [&] { return ns_from_seconds(random.uniform(kShortest_s, kLongest_s)); };
    commandline::Progress progress("switch", static_cast<std::uint64_t>(switches), show_progress);
    watch_until(monotonic_now_ns() + pause_ns());
    for (int i = 0; i < switches && !g_preflight_interrupted; ++i) {
      const bool on = i % 2 == 0;
      lamp_.set(on);
      watched_.switches.push_back({monotonic_now_ns(), on});
      progress.show(static_cast<std::uint64_t>(i + 1));
      watch_until(watched_.switches.back().t_ns + pause_ns());
    }
    progress.clear();
    if (g_preflight_interrupted) throw Error("interrupted; the light is as it was");
    return std::move(watched_);
  }
  const std::string& no_vision() const { return vision_.missing(); }
  const std::string& description() const { return source_->description(); }

 private:
  void wait_for_first_frame() {
    const TimeNs end_ns = monotonic_now_ns() + kFirstFrame_ns;
    while (watched_.frames.empty() && !g_preflight_interrupted) {
      if (monotonic_now_ns() > end_ns) throw Error(source_->address() + ": no picture came");
      watch_until(monotonic_now_ns() + kNsPerS / 10);
    }
  }

  void watch_until(TimeNs t_ns) {
    while (!g_preflight_interrupted) {
      const TimeNs left_ns = t_ns - monotonic_now_ns();
      if (left_ns <= 0) return;
      FrameView frame;
      const FrameResult result = source_->wait_frame(left_ns, frame);
      const TimeNs now_ns = monotonic_now_ns();
      if (result == FrameResult::Lost) throw Error(source_->problem());
      if (result == FrameResult::EndOfStream)
        throw Error(source_->address() + ": has ended (expected a camera that sees the light)");
      if (result == FrameResult::Frame) {
        take(frame, now_ns);
      } else if (!watched_.frames.empty() && now_ns - watched_.frames.back().t_dequeued_ns > kNoFrame_ns) {
        throw Error(source_->address() + ": no picture for 2 s");
      }
    }
  }

  void take(const FrameView& frame, TimeNs now_ns) {
    watched_.frames.push_back({frame.header.t_capture_ns, now_ns, evaluation::tile_levels(frame)});
    vision_.see(frame);
    watched_.t_done_ns.push_back(monotonic_now_ns());
  }

  std::unique_ptr<FrameSource> source_;
  MeasuredVision vision_;
  Lamp& lamp_;
  Watched watched_;
};

/// The times of one hop, or of several together, of each switch that was seen.
struct Times {
  std::vector<double> ms;

  void add(TimeNs from_ns, TimeNs to_ns) { ms.push_back(1e-6 * static_cast<double>(to_ns - from_ns)); }
  evaluation::LatencyHop hop(const char* name) const {
    const auto at = [&](double share) { return evaluation::quantile(ms, share); };
    return {name, ms.size(), at(0.5), at(0.99), at(1.0)};
  }
};

}  // namespace

LightFigures measure_light(const Config& config, const std::string& lamp_file, int switches) {
  note_interrupts();
  const RobotAddress robot = parse_robot_address(config.robot.address);
  const std::unique_ptr<Lamp> lamp = lamp_file.empty() ? terminal_lamp() : file_lamp(lamp_file);
  LightWatch watch(config, *lamp);
  const Watched watched = watch.run(switches, !lamp_file.empty());
  const evaluation::LightResponse response = evaluation::light_response(watched.frames, watched.switches);

  const TimeNs period_ns = ns_from_seconds(1.0 / config.control.rate_hz);
  const TimeNs wire_ns =
      robot.kind == RobotAddress::Kind::Tcp ? 0 : ns_from_seconds(kCommandBits / robot.baud);
  Times to_stamp, to_dequeued, vision, to_tick, wire, from_light, total;
  for (const evaluation::LightSeen& seen : response.seen) {
    const TimeNs t_light_ns = watched.switches[seen.switched].t_ns;
    const LightFrame& frame = watched.frames[seen.frame];
    const TimeNs t_done_ns = watched.t_done_ns[seen.frame];
    const TimeNs t_tick_ns = (t_done_ns / period_ns + 1) * period_ns;
    to_stamp.add(t_light_ns, frame.t_capture_ns);
    to_dequeued.add(frame.t_capture_ns, frame.t_dequeued_ns);
    from_light.add(t_light_ns, frame.t_dequeued_ns);
    vision.add(frame.t_dequeued_ns, t_done_ns);
    to_tick.add(t_done_ns, t_tick_ns);
    wire.add(0, wire_ns);
    total.add(t_light_ns, t_tick_ns + wire_ns);
  }
  if (response.seen.empty()) throw Error("the light: no frame has shown a change");

  LightFigures figures{.camera = watch.description(),
                       .switches = watched.switches.size(),
                       .seen = response.seen.size(),
                       .tiles = response.tiles,
                       .contrast = response.contrast,
                       .no_vision = watch.no_vision(),
                       .period_ms = 1e-6 * static_cast<double>(period_ns),
                       .hops = {to_stamp.hop("light to stamp"), to_dequeued.hop("stamp to dequeued")},
                       .to_dequeued = from_light.hop("light to dequeued"),
                       .total = total.hop("light to last byte")};
  if (figures.no_vision.empty()) figures.hops.push_back(vision.hop("vision"));
  figures.hops.push_back(to_tick.hop("vision to tick"));
  if (wire_ns > 0) figures.hops.push_back(wire.hop("command on the line"));
  return figures;
}

}  // namespace heel::cli
