#include "operator/web/metrics.h"

#include <prometheus/metric_family.h>
#include <prometheus/text_serializer.h>

#include <cmath>
#include <limits>
#include <sstream>
#include <utility>
#include <vector>

namespace heel {
namespace {

using prometheus::ClientMetric;
using prometheus::MetricFamily;
using prometheus::MetricType;

MetricFamily& add_family(std::vector<MetricFamily>& families, const char* name, const char* help,
                         MetricType type) {
  MetricFamily family;
  family.name = name;
  family.help = help;
  family.type = type;
  families.push_back(std::move(family));
  return families.back();
}

void add_gauge(std::vector<MetricFamily>& families, const char* name, const char* help, double value) {
  ClientMetric metric;
  metric.gauge.value = value;
  add_family(families, name, help, MetricType::Gauge).metric.push_back(metric);
}

void add_counter(std::vector<MetricFamily>& families, const char* name, const char* help,
                 std::uint64_t value) {
  ClientMetric metric;
  metric.counter.value = static_cast<double>(value);
  add_family(families, name, help, MetricType::Counter).metric.push_back(metric);
}

/// 1 for the name that holds, 0 for the others.
template <typename Name>
void add_states(std::vector<MetricFamily>& families, const char* name, const char* help, Name last,
                Name current) {
  MetricFamily& family = add_family(families, name, help, MetricType::Gauge);
  for (int value = 0; value <= static_cast<int>(last); ++value) {
    ClientMetric metric;
    metric.label.push_back({"name", to_string(static_cast<Name>(value))});
    metric.gauge.value = value == static_cast<int>(current) ? 1.0 : 0.0;
    family.metric.push_back(metric);
  }
}

void add_lateness(std::vector<MetricFamily>& families, const LatenessCounts::Values& lateness) {
  ClientMetric metric;
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < lateness.counts.size(); ++i) {
    count += lateness.counts[i];
    ClientMetric::Bucket bucket;
    bucket.cumulative_count = count;
    bucket.upper_bound = i < LatenessCounts::kBounds_ns.size()
                             ? seconds_from_ns(LatenessCounts::kBounds_ns[i])
                             : std::numeric_limits<double>::infinity();
    metric.histogram.bucket.push_back(bucket);
  }
  metric.histogram.sample_count = count;
  metric.histogram.sample_sum = seconds_from_ns(lateness.sum_ns);
  add_family(families, "heel_control_lateness_seconds", "Control ticks: how late each began.",
             MetricType::Histogram)
      .metric.push_back(metric);
}

void add_robot(std::vector<MetricFamily>& out, const RobotState& robot) {
  add_states(out, "heel_robot_link", "Phase of the line to the robot.", LinkPhase::Refused, robot.phase);
  if (robot.has_sip) add_gauge(out, "heel_battery_volts", "Battery of the robot.", robot.battery_v);
  add_gauge(out, "heel_motors_enabled", "1: the robot's motors are on.", robot.motors_enabled ? 1.0 : 0.0);
  add_counter(out, "heel_robot_packets_total", "Packets received from the robot.", robot.sips);
  add_counter(out, "heel_robot_checksum_errors_total", "Packets of the robot that were damaged.",
              robot.checksum_errors);
  add_counter(out, "heel_robot_reconnects_total", "Times the line to the robot was opened again.",
              robot.reconnects);
}

void add_camera(std::vector<MetricFamily>& out, const TelemetrySnapshot& records) {
  const CaptureCounters& camera = records.capture;
  add_counter(out, "heel_frames_total", "Frames of the camera.", camera.captured);
  add_counter(out, "heel_frames_dropped_by_driver_total", "Frames that the camera's driver lost.",
              camera.dropped_by_driver);
  add_counter(out, "heel_frames_dropped_unread_total",
              "Frames replaced by newer ones before vision read them.", camera.dropped_unread);
  add_counter(out, "heel_camera_reopened_total", "Times the camera was opened again.", camera.reopened);
  add_counter(out, "heel_poses_total", "Frames that vision has processed.", records.poses);
}

}  // namespace

std::string metrics_text(const MetricsInput& input) {
  std::vector<MetricFamily> out;
  const TickRecord& tick = input.records.tick;
  add_counter(out, "heel_control_ticks_total", "Control ticks.", input.records.ticks);
  add_lateness(out, input.lateness);
  add_counter(out, "heel_control_overruns_total", "Periods of the control loop that were missed.",
              input.missed_periods);
  add_counter(out, "heel_records_lost_total", "Records of telemetry that were lost.",
              input.records.records_lost);
  add_gauge(out, "heel_page_viewers", "Browsers that look at live data.", static_cast<double>(input.viewers));
  add_counter(out, "heel_page_pictures_total", "Pictures encoded for browsers.", input.pictures);
  add_camera(out, input.records);
  if (input.records.ticks > 0) {
    add_states(out, "heel_state", "State of the supervisor.", SupervisorState::Emergency, tick.state);
    add_states(out, "heel_stop_reason", "Why the robot does not follow.", StopReason::EmergencyStop,
               tick.stop_reason);
    add_robot(out, tick.input.robot);
    add_gauge(out, "heel_target_known", "1: the person's place is known.", tick.target.known ? 1.0 : 0.0);
    add_gauge(out, "heel_certainty", "Certainty of the newest frame, 0 to 1.", tick.input.pose.certainty);
    add_gauge(out, "heel_command_speed_meters_per_second", "Speed commanded.", tick.command.v_m_s);
    add_gauge(out, "heel_tick_age_seconds", "Age of the newest control tick.",
              seconds_from_ns(input.now_ns - tick.input.now_ns));
  }
  std::ostringstream text;
  prometheus::TextSerializer().Serialize(text, out);
  return text.str();
}

}  // namespace heel
