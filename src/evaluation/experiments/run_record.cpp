#include "evaluation/experiments/run_record.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <opencv2/imgcodecs.hpp>

#include "files/template_file.h"
#include "heel/error.h"
#include "sim/scene/truth_columns.h"

namespace heel::evaluation {
namespace {

constexpr int kSavedFrames = 12;
constexpr std::uint64_t kTicksAFlush = 50;

}  // namespace

MotionSample motion_sample(const sim::TruthMoment& truth) {
  MotionSample sample;
  sample.t_s = seconds_from_ns(truth.t_ns);
  sample.robot = {truth.robot.pose.x_m, truth.robot.pose.y_m, truth.robot.pose.heading_rad};
  sample.has_person = truth.has_world;
  sample.person = {truth.world.person.x_m, truth.world.person.y_m, truth.world.person.heading_rad};
  sample.person_speed_m_s = truth.world.person.speed_m_s;
  sample.back_in_view = truth.world.in_view && !truth.world.occluded;
  sample.touching = truth.robot.bumpers_front != 0 || truth.robot.bumpers_rear != 0;
  return sample;
}

PoseSample pose_sample(const PoseEstimate& pose, const sim::TruthMoment& truth) {
  PoseSample sample;
  sample.t_s = seconds_from_ns(pose.t_capture_ns);
  sample.found = pose.found();
  sample.reason = to_string(pose.reason);
  sample.certainty = pose.certainty;
  sample.yaw_rad = pose.yaw_rad;
  sample.yaw_sigma_rad = pose.yaw_sigma_rad;
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

RunRecord::File RunRecord::create(const std::string& path) {
  File file(std::fopen(path.c_str(), "w"));
  if (!file) throw Error(path + ": cannot write: " + std::strerror(errno) + " (expected a writable folder)");
  return file;
}

RunRecord::RunRecord(const std::string& directory, const sim::LockstepSettings& settings)
    : directory_(directory) {
  if (directory.empty()) return;
  recorder_ = std::make_unique<Recorder>(directory);
  truth_ = create(directory + "/truth.csv");
  std::fputs(
      "t_s,robot_x_m,robot_y_m,robot_heading_rad,robot_v_m_s,robot_yaw_rate_rad_s,odom_x_m,odom_y_m,"
      "odom_heading_rad,motors_enabled",
      truth_.get());
  if (settings.scenario.camera.source == "sim")
    for (const sim::TruthColumn& column : sim::world_truth_columns())
      std::fprintf(truth_.get(), ",%s", column.name);
  std::fputc('\n', truth_.get());
  wire_ = create(directory + "/wire.hex");
  if (!settings.errors) {
    write_template(settings.shirt, directory + "/shirt.heel");
    std::filesystem::create_directories(directory + "/frames");
  }
  frame_interval_ns_ = ns_from_seconds(settings.scenario.duration_s / kSavedFrames);
  t_next_frame_ns_ = frame_interval_ns_ / 2;
}

void RunRecord::on_tick(const TickRecord& tick, const sim::TruthMoment& truth) {
  metrics_.add(motion_sample(truth));
  metrics_.add(tick_sample(tick));
  if (!recorder_) return;
  recorder_->record(tick);
  write_truth(truth);
  if (tick.tick % kTicksAFlush == 0) recorder_->flush();
}

void RunRecord::on_pose(const FrameView& frame, const PoseEstimate& pose, const sim::TruthMoment& truth) {
  metrics_.add(pose_sample(pose, truth));
  if (!recorder_) return;
  recorder_->record(pose);
  if (frame.grey == nullptr || pose.t_capture_ns < t_next_frame_ns_) return;
  t_next_frame_ns_ += frame_interval_ns_;
  save_frame(frame);
}

/// "seconds hex": one line a tick, as it went out.
void RunRecord::on_bytes_to_robot(std::span<const std::uint8_t> bytes, TimeNs t_ns) {
  if (!wire_) return;
  std::fprintf(wire_.get(), "%.3f ", seconds_from_ns(t_ns));
  for (const std::uint8_t byte : bytes) std::fprintf(wire_.get(), "%02x", byte);
  std::fputc('\n', wire_.get());
}

void RunRecord::flush() {
  if (!recorder_) return;
  recorder_->flush();
  std::fflush(truth_.get());
  std::fflush(wire_.get());
}

void RunRecord::write_truth(const sim::TruthMoment& truth) {
  const sim::RobotTruth& robot = truth.robot;
  std::fprintf(truth_.get(), "%.4f,%.5f,%.5f,%.6f,%.5f,%.6f,%.5f,%.5f,%.6f,%d", seconds_from_ns(truth.t_ns),
               robot.pose.x_m, robot.pose.y_m, robot.pose.heading_rad, robot.v_m_s, robot.yaw_rate_rad_s,
               robot.odometry.x_m, robot.odometry.y_m, robot.odometry.heading_rad, robot.motors_enabled);
  if (truth.has_world)
    for (const sim::TruthColumn& column : sim::world_truth_columns())
      std::fprintf(truth_.get(), ",%.*f", column.decimals, column.value(truth.world));
  std::fputc('\n', truth_.get());
}

void RunRecord::save_frame(const FrameView& frame) const {
  char name[32];
  std::snprintf(name, sizeof name, "/frames/%06llu.png",
                static_cast<unsigned long long>(frame.header.sequence));
  // OpenCV wants a mutable pointer; it only reads.
  const cv::Mat picture(static_cast<int>(frame.header.height_px), static_cast<int>(frame.header.width_px),
                        CV_8U, const_cast<std::uint8_t*>(frame.grey), frame.stride_bytes);
  cv::imwrite(directory_ + name, picture);
}

}  // namespace heel::evaluation
