#include "sim/lockstep/lockstep.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "control/control_stage.h"
#include "core/picture_turn.h"
#include "core/random.h"
#include "heel/error.h"
#include "models/robot_models.h"
#include "robot/arcos_session.h"
#include "sim/contact/contact.h"
#include "sim/contact/robot_in_world.h"
#include "sim/lockstep/frame_supply.h"
#include "sim/pose_noise/sampled_poses.h"
#include "sim/scene/sent_picture.h"
#include "vision/pose/template_selector.h"
#include "vision/template/turned_template.h"

namespace heel::sim {
namespace {

class Lockstep {
 public:
  Lockstep(const LockstepSettings& settings, LockstepObserver& observer);
  LockstepCounts run();

 private:
  /// A frame that vision has not processed yet.
  struct CapturedFrame {
    std::uint64_t sequence = 0;
    TimeNs t_ns = 0;  ///< middle
    TimeNs stamp_error_ns = 0;
    RobotMotion robot;
    LockstepTruth truth;
  };
  struct PendingPose {
    PoseEstimate pose;
    TimeNs t_visible_ns = 0;
  };

  void advance_line(TimeNs t_ns);
  void capture_frame(TimeNs t_ns);
  TimeNs readable_ns(TimeNs t_ns) const;
  void run_vision(const CapturedFrame& captured, TimeNs t_start_ns);
  void tick(TimeNs t_ns, bool shutdown);
  void send(std::span<const std::uint8_t> bytes, TimeNs t_ns);
  RobotMotion motion_at(TimeNs t_ns) const;
  LockstepTruth truth_at(TimeNs t_ns) const;

  const Scenario scenario_;
  const double control_rate_hz_;
  PictureTurner turner_;  ///< as the configuration says
  LockstepObserver& observer_;
  std::unique_ptr<World> world_;  ///< none when frames come from a file
  std::unique_ptr<FrameSupply> frames_;
  std::optional<TemplateSelector> vision_;     ///< with pictures
  std::optional<SampledPoses> sampled_poses_;  ///< without
  SimulatedOperator operator_;
  ControlStage control_;
  ArcosSession session_;
  P3At robot_;
  std::optional<Contact> contact_;  ///< with a world

  TimeNs t_line_ns_ = 0;  ///< robot and line have been simulated up to here
  TimeNs t_vision_free_ns_ = 0;
  TimeNs t_last_ready_ns_ = 0;                  ///< frames stay in order
  std::optional<CapturedFrame> waiting_frame_;  ///< for vision; a newer one replaces it
  std::deque<PendingPose> pending_poses_;       ///< not yet visible to control; in order
  PoseEstimate newest_pose_;
  bool has_pose_ = false;
  bool frames_ended_ = false;
  LockstepCounts counts_;
};

Lockstep::Lockstep(const LockstepSettings& settings, LockstepObserver& observer)
    : scenario_(settings.scenario),
      control_rate_hz_(settings.config.control.rate_hz),
      turner_(picture_turn(settings.config.camera.rotate, settings.config.camera.mirror)),
      observer_(observer),
      operator_(settings.operator_actions),
      control_(control_config(settings), robot_models()),
      session_(settings.config.robot),
      robot_(robot_settings(settings.scenario), derived_seed(settings.scenario.seed, 0x60)) {
  if (settings.errors) {
    world_ = std::make_unique<World>(scenario_, 1, WorldUse::TruthOnly);
    contact_.emplace(*world_, robot_);
    sampled_poses_.emplace(*settings.errors, scenario_, settings.shirt.distance_m,
                           derived_seed(scenario_.seed, 0xe0));
    return;
  }
  std::vector<ShirtTemplate> shirts{settings.shirt};
  shirts.insert(shirts.end(), settings.more_shirts.begin(), settings.more_shirts.end());
  const CameraModel sent = sent_camera(scenario_.camera);
  vision_.emplace(templates_for_turned(shirts, sent, turner_.turn()).shirts,
                  turned_camera(sent, turner_.turn()), settings.config.vision);
  if (scenario_.camera.source == "sim") {
    world_ = std::make_unique<World>(scenario_);
    frames_ = make_world_supply(*world_);
    contact_.emplace(*world_, robot_);
  } else {
    frames_ = make_file_supply(scenario_.camera.source, scenario_.camera.model.width_px,
                               scenario_.camera.model.height_px);
  }
}

LockstepCounts Lockstep::run() {
  const TimeNs tick_period_ns = ns_from_seconds(1.0 / control_rate_hz_);
  const TimeNs frame_period_ns = ns_from_seconds(1.0 / scenario_.camera.rate_hz);
  const TimeNs t_end_ns = ns_from_seconds(scenario_.duration_s);
  TimeNs t_tick_ns = 0;
  TimeNs t_frame_ns = frame_period_ns;
  session_.line_opened(0);
  while (t_tick_ns < t_end_ns && !frames_ended_) {
    if (t_frame_ns < t_tick_ns) {
      advance_line(t_frame_ns);
      capture_frame(t_frame_ns);
      t_frame_ns += frame_period_ns;
    } else {
      advance_line(t_tick_ns);
      tick(t_tick_ns, /*shutdown=*/false);
      t_tick_ns += tick_period_ns;
    }
  }
  advance_line(t_tick_ns);
  tick(t_tick_ns, /*shutdown=*/true);
  send(session_.close(t_tick_ns), t_tick_ns);
  return counts_;
}

/// Bytes travel in steps of a millisecond, so that a SIP is stamped when it came, not at the next tick.
void Lockstep::advance_line(TimeNs t_ns) {
  const TimeNs t_before_ns = t_line_ns_;
  while (t_line_ns_ + P3At::kStep_ns <= t_ns) {
    t_line_ns_ += P3At::kStep_ns;
    robot_.advance(t_line_ns_);
    if (contact_) contact_->step(seconds_from_ns(t_line_ns_));
    const auto bytes = robot_.take_output();
    session_.receive(bytes, t_line_ns_);
    if (!bytes.empty()) observer_.on_bytes_from_robot(bytes, t_line_ns_);
  }
  if (!world_) return;
  start_walk_when_motors_run(robot_.truth(), seconds_from_ns(t_ns), *world_);
  hold_walk_while_robot_is_far(robot_.truth(), seconds_from_ns(t_ns),
                               seconds_from_ns(t_line_ns_ - t_before_ns), *world_);
}

RobotMotion Lockstep::motion_at(TimeNs t_ns) const {
  const RobotTruth truth = robot_.truth();
  // The model stands at the last whole millisecond.
  const double dt_s = seconds_from_ns(t_ns - t_line_ns_);
  RobotMotion motion = robot_motion_from_truth(truth);
  motion.x_m += dt_s * truth.v_m_s * std::cos(truth.pose.heading_rad);
  motion.y_m += dt_s * truth.v_m_s * std::sin(truth.pose.heading_rad);
  motion.heading_rad += dt_s * truth.yaw_rate_rad_s;
  return motion;
}

LockstepTruth Lockstep::truth_at(TimeNs t_ns) const {
  LockstepTruth truth;
  truth.t_ns = t_ns;
  truth.robot = robot_.truth();
  if (world_) {
    truth.has_world = true;
    truth.world = world_->truth(motion_at(t_ns), seconds_from_ns(t_ns));
    truth.walking = truth.world.person.speed_m_s > 0.02;
  }
  return truth;
}

/// When the last row's exposure has ended.
TimeNs Lockstep::readable_ns(TimeNs t_ns) const {
  const double open_ms =
      world_ ? world_->exposure(seconds_from_ns(t_ns)).exposure_ms : scenario_.camera.sensor.exposure_ms;
  return t_ns + ns_from_seconds(0.5e-3 * (open_ms + scenario_.camera.readout_ms));
}

/// Vision takes the newest frame as soon as it is free; a frame that is replaced meanwhile is never
/// processed.
void Lockstep::capture_frame(TimeNs t_ns) {
  ++counts_.frames;
  const FrameDelivery delivery = frame_delivery(scenario_.camera.timing, scenario_.seed, counts_.frames);
  if (delivery.dropped) {
    ++counts_.frames_dropped;
    return;
  }
  const TimeNs t_ready_ns = std::max(t_last_ready_ns_, readable_ns(t_ns) + delivery.delay_ns);
  t_last_ready_ns_ = t_ready_ns;
  const CapturedFrame captured{counts_.frames, t_ns, delivery.stamp_error_ns, motion_at(t_ns),
                               truth_at(t_ns)};
  if (waiting_frame_ && t_ready_ns >= t_vision_free_ns_) {
    // Vision became free before this frame: it took the waiting one.
    run_vision(*waiting_frame_, t_vision_free_ns_);
    waiting_frame_.reset();
  }
  if (t_ready_ns >= t_vision_free_ns_) {
    run_vision(captured, t_ready_ns);
    return;
  }
  if (waiting_frame_) ++counts_.frames_overtaken;
  waiting_frame_ = captured;
}

void Lockstep::run_vision(const CapturedFrame& captured, TimeNs t_start_ns) {
  FrameView frame;
  PoseEstimate pose;
  double latency_ms = scenario_.vision_latency_ms;
  if (sampled_poses_) {
    frame.header.sequence = captured.sequence;
    frame.header.t_capture_ns = captured.t_ns + captured.stamp_error_ns;
    pose = sampled_poses_->estimate(frame.header, captured.robot, captured.truth.world);
    latency_ms *= sampled_poses_->time_share();
  } else {
    frame = frames_->frame(captured.sequence, captured.t_ns, captured.robot);
    if (frame.grey == nullptr) {
      frames_ended_ = true;
      return;
    }
    frame = turner_.of(frame);
    frame.header.t_capture_ns += captured.stamp_error_ns;
    pose = vision_->estimate(frame);
  }
  t_vision_free_ns_ = t_start_ns + ns_from_seconds(1e-3 * latency_ms);
  PendingPose done{pose, t_vision_free_ns_};
  done.pose.t_done_ns = t_vision_free_ns_;
  pending_poses_.push_back(done);
  observer_.on_pose(frame, done.pose, captured.truth);
}

void Lockstep::tick(TimeNs t_ns, bool shutdown) {
  if (waiting_frame_ && t_ns >= t_vision_free_ns_) {
    run_vision(*waiting_frame_, t_vision_free_ns_);
    waiting_frame_.reset();
  }
  while (!pending_poses_.empty() && pending_poses_.front().t_visible_ns <= t_ns) {
    newest_pose_ = pending_poses_.front().pose;
    has_pose_ = true;
    pending_poses_.pop_front();
  }
  session_.advance(t_ns);
  ControlInput input;
  input.now_ns = t_ns;
  input.robot = session_.state();
  input.pose = newest_pose_;
  input.has_pose = has_pose_;
  input.request = operator_.request_at(t_ns);
  input.t_operator_ns = input.request.t_ns;
  input.shutdown = shutdown;
  const TickRecord record = control_.tick(input);
  ++counts_.ticks;
  if (record.enable_motors) session_.enable_motors_again(t_ns);
  send(session_.send(record.command, t_ns), t_ns);
  observer_.on_tick(record, truth_at(t_ns));
}

void Lockstep::send(std::span<const std::uint8_t> bytes, TimeNs t_ns) {
  if (bytes.empty()) return;
  robot_.receive(bytes, t_ns);
  observer_.on_bytes_to_robot(bytes, t_ns);
}

}  // namespace

Config control_config(const LockstepSettings& settings) {
  Config config = settings.config;
  if (settings.operator_actions.empty()) config.supervisor.start = "at_once";
  return config;
}

LockstepCounts run_lockstep(const LockstepSettings& settings, LockstepObserver& observer) {
  if (settings.errors && settings.scenario.camera.source != "sim")
    throw Error("scenario " + settings.scenario.name + ": frames come from " +
                settings.scenario.camera.source +
                " (expected the simulated world: an error model draws poses from its truth)");
  return Lockstep(settings, observer).run();
}

ShirtTemplate teach_from_world(const Scenario& scenario, double distance_m) {
  ShirtTemplate shirt = sent_reference_view(scenario, distance_m);
  const TemplateVerdict verdict = judge_template(shirt);
  if (!verdict.usable)
    throw Error("scenario " + scenario.name + ": the shirt cannot be followed: " + verdict.reason);
  return shirt;
}

void apply_scenario(const Scenario& scenario, Config& config) {
  const ScenarioCamera& camera = scenario.camera;
  const CameraModel sent = sent_camera(camera);
  if (camera.source != "sim") config.camera.source = camera.source;
  config.camera.width_px = sent.width_px;
  config.camera.height_px = sent.height_px;
  config.camera.rate_hz = camera.rate_hz;
  config.camera.mount_x_m = camera.mount_x_m;
  config.camera.mount_y_m = camera.mount_y_m;
  config.camera.mount_z_m = camera.mount_z_m;
  config.camera.mount_pitch_rad = camera.mount_pitch_rad;
  config.robot.address = "pty:lockstep@38400";
}

P3AtSettings robot_settings(const Scenario& scenario) {
  P3AtSettings settings;
  settings.boot_baud = 38400;
  apply_robot(scenario.robot, settings);
  return settings;
}

}  // namespace heel::sim
