#include "operator/mqtt/mqtt_publisher.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <exception>
#include <nlohmann/json.hpp>
#include <utility>

#include "operator/mqtt/broker_login.h"
#include "operator/status.h"
#include "realtime/clock.h"
#include "shared_module/shared_module.h"

namespace heel {
namespace {

constexpr TimeNs kLook_ns = 50 * kNsPerMs;      // for a change of the state; telemetry takes records as often
constexpr TimeNs kSpacing_ns = 100 * kNsPerMs;  // least time between two of them
constexpr TimeNs kStable_ns = 60 * kNsPerS;     // a connection that has lasted so long was no accident
constexpr TimeNs kFarewell_ns = 500 * kNsPerMs;  // for the broker to confirm that heeld is gone

std::unique_ptr<BrokerLine> line_of_module(const MqttConfig& config) {
  void* const entry = module_entry("mqtt", kBrokerLineEntry, fmt::format("mqtt.address: {}", config.address));
  return std::unique_ptr<BrokerLine>(reinterpret_cast<BrokerLineEntry*>(entry)(broker_login(config)));
}

}  // namespace

MqttPublisher::MqttPublisher(const MqttConfig& config, const MqttParts& parts)
    : MqttPublisher(config, parts, line_of_module(config)) {}

MqttPublisher::MqttPublisher(const MqttConfig& config, const MqttParts& parts,
                             std::unique_ptr<BrokerLine> line)
    : address_(config.address),
      topic_(mqtt_topic(config)),
      exposure_(mqtt_exposure(config)),
      period_ns_(ns_from_seconds(config.period_s)),
      parts_(parts),
      line_(std::move(line)) {}

void MqttPublisher::run() {
  spdlog::info("{}", exposure_);
  do step();
  while (pause(connected_ ? 0 : backoff_.next()));
  leave();
}

void MqttPublisher::step() {
  try {
    if (!connected_) connect();
    if (connected_) serve();
  } catch (const std::exception& error) {  // a defect here does not stop the robot's daemon
    lost(error.what());
  }
}

void MqttPublisher::stop() {
  const std::lock_guard lock(mutex_);
  stop_ = true;
  stopped_.notify_all();
}

/// False: stop() was called.
bool MqttPublisher::pause(TimeNs pause_ns) {
  std::unique_lock lock(mutex_);
  return !stopped_.wait_for(lock, std::chrono::nanoseconds(pause_ns), [this] { return stop_; });
}

void MqttPublisher::connect() {
  const std::string problem = line_->connect();
  if (!problem.empty()) {
    lost(problem);
    return;
  }
  connected_ = true;
  stable_ = announced_ = false;
  t_connected_ns_ = monotonic_now_ns();
  t_published_ns_ = 0;
  if (tell_connected_) spdlog::info("mqtt: connected to {}", address_);
  tell_connected_ = false;
}

void MqttPublisher::serve() {
  if (!stable_ && monotonic_now_ns() - t_connected_ns_ > kStable_ns) {
    stable_ = true;
    backoff_.reset();
    reasons_.forget();
  }
  if (line_->confirmed()) publish();
  if (connected_ && !line_->serve(kLook_ns))
    lost("the connection is lost (is the broker gone, or does another client use this mqtt.topic?)");
}

/// What is due, if any.
void MqttPublisher::publish() {
  bool sent = true;
  if (!announced_) {
    sent = announced_ = line_->publish(topic_ + "/online", "online");
  } else {
    const TelemetrySnapshot newest = parts_.telemetry.snapshot();
    const TimeNs now_ns = monotonic_now_ns();
    if (!status_is_due(newest.tick, now_ns)) return;
    sent = line_->publish(topic_ + "/status", status_text(newest, now_ns));
    t_published_ns_ = now_ns;
    published_ = newest.tick;
  }
  if (!sent) lost("the broker takes no message");
}

bool MqttPublisher::status_is_due(const TickRecord& newest, TimeNs now_ns) const {
  const TimeNs since_ns = now_ns - t_published_ns_;
  return t_published_ns_ == 0 || since_ns >= period_ns_ ||
         (since_ns >= kSpacing_ns && differs_to_a_watcher(published_, newest));
}

std::string MqttPublisher::status_text(const TelemetrySnapshot& newest, TimeNs now_ns) const {
  const StatusInput input{newest.tick, newest.ticks > 0, parts_.port.camera(), now_ns};
  return status_json(input, parts_.settings.view())
      .dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

void MqttPublisher::lost(const std::string& reason) {
  connected_ = false;
  if (!reasons_.is_news(reason)) return;
  tell_connected_ = true;
  spdlog::warn("mqtt: {}: {}; heeld goes on without it and tries again", address_, reason);
}

void MqttPublisher::leave() {
  if (!connected_) return;
  const TimeNs end_ns = monotonic_now_ns() + kFarewell_ns;
  const auto is_confirmed = [&] {
    while (!line_->confirmed())
      if (monotonic_now_ns() > end_ns || !line_->serve(kLook_ns)) return false;
    return true;
  };
  // A broker that does not confirm it publishes the will, because the connection then ends without a
  // farewell.
  if (is_confirmed() && line_->publish(topic_ + "/online", "offline") && is_confirmed()) line_->disconnect();
}

}  // namespace heel
