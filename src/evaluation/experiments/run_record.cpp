#include "evaluation/experiments/run_record.h"

#include <fmt/format.h>

#include <filesystem>

#include "config/config_text.h"
#include "files/atomic_file.h"
#include "files/camera_info.h"
#include "files/folder.h"
#include "files/image_file.h"
#include "files/template_file.h"
#include "sim/robot/truth_columns.h"
#include "sim/scene/truth_columns.h"

namespace heel::evaluation {
namespace {

constexpr int kSavedFrames = 12;
constexpr std::uint64_t kFlushTicks = 50;
constexpr int kWireDecimals = 3;

}  // namespace

MotionSample motion_sample(const sim::LockstepTruth& truth) {
  MotionSample sample;
  sample.t_s = seconds_from_ns(truth.t_ns);
  sample.robot = {truth.robot.pose.x_m, truth.robot.pose.y_m, truth.robot.pose.heading_rad};
  sample.has_person = truth.has_world;
  sample.person = {truth.world.person.x_m, truth.world.person.y_m, truth.world.person.heading_rad};
  sample.person_speed_m_s = truth.world.person.speed_m_s;
  sample.back_in_view = truth.world.in_view && !truth.world.occluded;
  sample.back_hidden = truth.world.occluded;
  sample.has_back = truth.has_world;
  sample.back_x_m = truth.world.back_m.x();
  sample.back_y_m = truth.world.back_m.y();
  sample.back_yaw_rad = truth.world.yaw_rad;
  sample.touching = truth.robot.bumpers_front != 0 || truth.robot.bumpers_rear != 0;
  sample.robot_v_m_s = truth.robot.v_m_s;
  sample.robot_yaw_rate_rad_s = truth.robot.yaw_rate_rad_s;
  return sample;
}

PoseSample pose_sample(const PoseEstimate& pose, const sim::LockstepTruth& truth) {
  PoseSample sample;
  sample.t_s = seconds_from_ns(pose.t_capture_ns);
  sample.found = pose.found();
  sample.reason = to_string(pose.reason);
  sample.certainty = pose.certainty;
  sample.yaw_rad = pose.frame_yaw_rad;
  sample.yaw_sigma_rad = pose.frame_yaw_sigma_rad;
  sample.x_m = pose.position_m[0];
  sample.y_m = pose.position_m[1];
  sample.z_m = pose.position_m[2];
  sample.has_truth = truth.has_world && pose.has_distance;
  sample.true_yaw_rad = truth.world.yaw_rad;
  sample.true_x_m = truth.world.back_in_camera_m.x();
  sample.true_y_m = truth.world.back_in_camera_m.y();
  sample.true_z_m = truth.world.back_in_camera_m.z();
  return sample;
}

TickSample tick_sample(const TickRecord& tick) {
  TickSample sample;
  sample.t_s = seconds_from_ns(tick.input.now_ns);
  sample.stop_reason = to_string(tick.stop_reason);
  sample.v_m_s = tick.command.v_m_s;
  sample.yaw_rate_rad_s = tick.command.yaw_rate_rad_s;
  return sample;
}

FollowReference follow_reference(const sim::LockstepSettings& settings) {
  const CameraConfig& camera = settings.config.camera;
  FollowReference reference;
  reference.set_distance_m =
      settings.shirt.distance_m + settings.config.control.setpoint_t_z_m + camera.mount_x_m;
  reference.camera_x_m = camera.mount_x_m;
  reference.camera_y_m = camera.mount_y_m;
  reference.separation_m = settings.config.gate.separation_m;
  return reference;
}

RunRecord::RunRecord(const std::string& directory, const sim::LockstepSettings& settings)
    : directory_(directory), metrics_(follow_reference(settings)) {
  if (directory.empty()) return;
  make_folder(directory);
  std::filesystem::remove(directory + "/run.mcap");
  recorder_ = std::make_unique<Recorder>(directory + "/run.mcap", RecordingClock{});
  recorder_->record(ConfigurationText{0, 0, config_toml(sim::control_config(settings))});
  open_truth(settings.scenario.camera.source == "sim");
  wire_ = std::make_unique<sim::WireFile>(directory + "/wire.hex", kWireDecimals);
  if (!settings.errors) {
    write_template(settings.shirt, directory + "/shirt.heel");
    make_folder(directory + "/frames");
    pictures_ = settings.config.telemetry.pictures;
    if (pictures_ != "none") attach_vision_files(settings);
  }
  frame_interval_ns_ = ns_from_seconds(settings.scenario.duration_s / kSavedFrames);
  t_next_frame_ns_ = frame_interval_ns_ / 2;
}

/// What a replay of vision needs beside the pictures.
void RunRecord::attach_vision_files(const sim::LockstepSettings& settings) {
  constexpr std::size_t kMaxBytes = 1 << 26;
  const std::string file = directory_ + "/attached";
  const auto attach = [&](const std::string& name, const std::string& media_type) {
    recorder_->attach(name, media_type, read_whole_file(file, kMaxBytes));
    std::filesystem::remove(file);
  };
  write_camera_model(settings.scenario.camera.model, file);
  attach("camera.yaml", "text/yaml");
  write_template(settings.shirt, file);
  attach("shirt-0.heel", "application/octet-stream");
  for (std::size_t i = 0; i < settings.more_shirts.size(); ++i) {
    write_template(settings.more_shirts[i], file);
    attach(fmt::format("shirt-{}.heel", i + 1), "application/octet-stream");
  }
}

void RunRecord::open_truth(bool has_world) {
  truth_file_ = std::make_unique<SampledCsv>(directory_ + "/truth.csv");
  truth_file_->add_column("t_s", 4, [this] { return seconds_from_ns(truth_.t_ns); });
  for (const sim::RobotTruthColumn& column : sim::robot_motion_columns())
    truth_file_->add_column(column.name, column.decimals,
                            [this, &column] { return column.value(truth_.robot); });
  truth_file_->add_column("motors_enabled", 0, [this] { return truth_.robot.motors_enabled ? 1.0 : 0.0; });
  if (!has_world) return;
  for (const sim::TruthColumn& column : sim::world_truth_columns())
    truth_file_->add_column(column.name, column.decimals,
                            [this, &column] { return column.value(truth_.world); });
}

void RunRecord::on_tick(const TickRecord& tick, const sim::LockstepTruth& truth) {
  metrics_.add(motion_sample(truth));
  metrics_.add(tick_sample(tick));
  if (!recorder_) return;
  recorder_->record(tick);
  truth_ = truth;
  truth_file_->write_row();
  if (tick.tick % kFlushTicks == 0) recorder_->flush();
}

void RunRecord::on_pose(const FrameView& frame, const PoseEstimate& pose, const sim::LockstepTruth& truth) {
  metrics_.add(pose_sample(pose, truth));
  if (!recorder_) return;
  recorder_->record(pose);
  if (frame.grey != nullptr && (pictures_ == "jpeg" || pictures_ == "lossless"))
    recorder_->record(compressed_picture(frame, pictures_ == "lossless"));
  if (frame.grey == nullptr || pose.t_capture_ns < t_next_frame_ns_) return;
  t_next_frame_ns_ += frame_interval_ns_;
  write_grey_image(fmt::format("{}/frames/{:06}.png", directory_, frame.header.sequence), frame.grey,
                   static_cast<int>(frame.header.width_px), static_cast<int>(frame.header.height_px),
                   frame.stride_bytes);
}

void RunRecord::on_bytes_to_robot(std::span<const std::uint8_t> bytes, TimeNs t_ns) {
  if (wire_) wire_->write(t_ns, bytes);
  if (recorder_) recorder_->record_wire(bytes, /*to_robot=*/true, t_ns);
}

void RunRecord::on_bytes_from_robot(std::span<const std::uint8_t> bytes, TimeNs t_ns) {
  if (recorder_) recorder_->record_wire(bytes, /*to_robot=*/false, t_ns);
}

void RunRecord::flush() {
  if (!recorder_) return;
  recorder_->flush();
  truth_file_->flush();
  wire_->flush();
}

}  // namespace heel::evaluation
