#include "operator/web/http_answers.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "operator/request.h"
#include "operator/web/config_json.h"
#include "operator/web/live_messages.h"
#include "operator/web/metrics.h"
#include "operator/web/origin.h"
#include "operator/web/view_json.h"
#include "operator/web/wall_clock.h"
#include "realtime/clock.h"

namespace heel {
namespace {

constexpr std::size_t kLinesWithoutN = 200;

/// The value of "n=20" in a query.
std::size_t count_of(std::string_view query) {
  std::size_t count = kLinesWithoutN;
  const std::size_t place = query.starts_with("n=") ? 0 : query.find("&n=");
  if (place == std::string_view::npos) return count;
  const std::string_view digits = query.substr(query.find('=', place) + 1);
  std::from_chars(digits.data(), digits.data() + digits.size(), count);
  return std::min(count, RecentLog::kKept);
}

ViewJson camera_json(const CameraModel& camera) {
  const double left_px = camera.undistort_px({-0.5, camera.cy}).x();
  const double right_px = camera.undistort_px({camera.width_px - 0.5, camera.cy}).x();
  const double hfov_rad =
      std::atan((camera.cx - left_px) / camera.fx) + std::atan((right_px - camera.cx) / camera.fx);
  return {{"width", camera.width_px}, {"height", camera.height_px}, {"hfov_rad", json_number(hfov_rad)}};
}

}  // namespace

PageAnswer page_error(unsigned status, const std::string& error) {
  return {status, "application/json", text_of({{"ok", false}, {"error", error}})};
}

PageAnswer HttpAnswers::check_site(const PageRequest& request) const {
  const std::vector<std::string> names = sources_.settings.view().file.view.hosts;
  if (!host_is_ours(request.host, names))
    return page_error(421,
                      fmt::format("Host: '{}' (expected an IP address, localhost, or a name in view.hosts)",
                                  request.host.substr(0, 100)));
  const bool viewer = request.target.starts_with("/foxglove") && origin_is_named(request.origin, names);
  if (!viewer && !origin_is_ours(request.origin, request.host))
    return page_error(
        403, fmt::format("Origin: '{}' (expected the page of this heeld)", request.origin.substr(0, 100)));
  const bool asks_for_data = request.target.starts_with("/api/") || request.target.starts_with("/metrics");
  if (request.fetch_site == "cross-site" && (asks_for_data || request.method != "GET"))
    return page_error(403, "a page of another site asks (expected the page of this heeld)");
  return {};
}

PageAnswer HttpAnswers::answer(const PageRequest& request) const {
  if (request.method != "GET" && request.method != "HEAD") {
    PageAnswer refused = page_error(405, "not served by this method (expected GET, or POST for /estop)");
    refused.allow = "GET, HEAD";
    return refused;
  }
  const std::string_view path = request.target.substr(0, request.target.find('?'));
  const std::string_view query = request.target.substr(std::min(path.size() + 1, request.target.size()));
  PageAnswer answer;
  if (path == "/api/info") {
    answer.body = info();
  } else if (path == "/api/config") {
    answer.body = text_of(config_json(sources_.settings.file(), sources_.settings.view()));
  } else if (path == "/api/log") {
    answer.body = log(query);
  } else if (path == "/metrics") {
    answer.media_type = "text/plain; version=0.0.4; charset=utf-8";
    answer.body =
        metrics_text({sources_.telemetry.snapshot(), sources_.feed.lateness(), sources_.feed.missed_periods(),
                      sources_.hub.viewers(), sources_.hub.pictures(), monotonic_now_ns()});
  } else if (path == "/estop") {
    answer = page_error(405, "not served by this method (expected POST)");
    answer.allow = "POST";
  } else if (const PageFile* file = files_.find(path)) {
    answer = {200, file->media_type, file->bytes, true};
  } else {
    answer = page_error(404, fmt::format("'{}': there is nothing of this name", path.substr(0, 100)));
  }
  return answer;
}

std::string HttpAnswers::info() const {
  const Config config = sources_.settings.view().in_use;
  const TelemetrySnapshot records = sources_.telemetry.snapshot();
  const RobotState& robot = records.tick.input.robot;
  const RobotModel& model = shown_robot(robot, config.robot.model);
  ViewJson out = {{"version", HEEL_VERSION}, {"protocol", kProtocolVersion}};
  out["robot"] = robot.kind.choice == ModelChoice::NotYet ? ViewJson() : ViewJson(model.subclass);
  out["needs_token"] = true;
  out["has_token"] = has_token_;
  out["recording"] = !config.telemetry.directory.empty();
  out["camera"] = camera_json(sources_.facts.camera);
  double distance_m = 0.0;
  if (!sources_.facts.templates.empty()) {
    const ShownTemplate& shirt = sources_.facts.templates.front();
    distance_m = shirt.distance_m;
    out["template"] = {{"width_m", json_number(shirt.width_m)},
                       {"height_m", json_number(shirt.height_m)},
                       {"distance_m", json_number(shirt.distance_m)}};
  }
  out["robot_outline"] = {{"front_m", json_number(model.geometry.front_m)},
                          {"rear_m", json_number(model.geometry.rear_m)},
                          {"width_m", json_number(2.0 * model.geometry.half_width_m)}};
  out["set_distance_m"] = json_number(distance_m + config.control.setpoint_t_z_m);
  return text_of(out);
}

std::string HttpAnswers::log(std::string_view query) const {
  const TimeNs wall_minus_monotonic_ns = wall_now_ns() - monotonic_now_ns();
  ViewJson events = ViewJson::array();
  for (const LoggedLine& line : sources_.log.after(0, count_of(query)))
    events.push_back(event_json(line, wall_minus_monotonic_ns));
  return text_of({{"events", std::move(events)}});
}

}  // namespace heel
