#include "recording/records.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "heel/error.h"
#include "recording/flow_json.h"
#include "recording/picture.h"
#include "recording/topics.h"
#include "recording/viewer_messages.h"

namespace heel {
namespace {

using RecordJson = nlohmann::ordered_json;

std::string dumped(const RecordJson& json) {
  return json.dump(-1, ' ', false, RecordJson::error_handler_t::replace);
}

RecordJson record_of(std::string_view text) {
  RecordJson json = RecordJson::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object()) throw Error("no JSON object");
  return json;
}

std::string text_at(const RecordJson& json, const char* name) {
  const auto found = json.find(name);
  if (found == json.end() || !found->is_string()) throw Error(std::string(name) + ": missing, or no text");
  return found->get<std::string>();
}

template <typename Number>
Number number_at(const RecordJson& json, const char* name) {
  const auto found = json.find(name);
  if (found == json.end() || !found->is_number_integer())
    throw Error(std::string(name) + ": missing, or no whole number");
  return found->get<Number>();
}

std::string object_schema(std::string_view title, const RecordJson& properties) {
  RecordJson schema{{"title", title}, {"type", "object"}, {"properties", properties}};
  for (const auto& [name, type] : properties.items()) schema["required"].push_back(name);
  return dumped(schema);
}

const RecordJson kText{{"type", "string"}};
const RecordJson kWhole{{"type", "integer"}};

/// Foxglove's stock schema, and the time of the recording's own clock.
std::string log_schema() {
  const RecordJson time{{"type", "object"}, {"properties", {{"sec", kWhole}, {"nsec", kWhole}}}};
  return object_schema("foxglove.Log", {{"timestamp", time},
                                        {"level", kWhole},
                                        {"message", kText},
                                        {"name", kText},
                                        {"file", kText},
                                        {"line", kWhole},
                                        {"t_ns", kWhole}});
}

}  // namespace

std::string log_json(const LogLine& line, TimeNs t_log_ns) {
  constexpr int kInfo = 2;  // of foxglove.Log
  return dumped({{"timestamp", {{"sec", t_log_ns / kNsPerS}, {"nsec", t_log_ns % kNsPerS}}},
                 {"level", kInfo},
                 {"message", line.text},
                 {"name", "heel"},
                 {"file", ""},
                 {"line", 0},
                 {"t_ns", line.t_ns}});
}

std::string configuration_json(const ConfigurationText& configuration) {
  return dumped(
      {{"t_ns", configuration.t_ns}, {"number", configuration.number}, {"text", configuration.text}});
}

std::string operator_json(const OperatorLine& line) {
  return dumped({{"t_ns", line.t_ns}, {"who", line.who}, {"request", line.request}, {"answer", line.answer}});
}

std::string note_json(const RecordingNote& note) {
  return dumped({{"t_ns", note.t_ns}, {"kind", note.kind}, {"text", note.text}, {"lost", note.lost}});
}

LogLine log_from_json(std::string_view text) {
  const RecordJson json = record_of(text);
  return {number_at<TimeNs>(json, "t_ns"), text_at(json, "message")};
}

ConfigurationText configuration_from_json(std::string_view text) {
  const RecordJson json = record_of(text);
  return {number_at<TimeNs>(json, "t_ns"), number_at<std::uint64_t>(json, "number"), text_at(json, "text")};
}

OperatorLine operator_from_json(std::string_view text) {
  const RecordJson json = record_of(text);
  return {number_at<TimeNs>(json, "t_ns"), text_at(json, "who"), text_at(json, "request"),
          text_at(json, "answer")};
}

RecordingNote note_from_json(std::string_view text) {
  const RecordJson json = record_of(text);
  return {number_at<TimeNs>(json, "t_ns"), text_at(json, "kind"), text_at(json, "text"),
          number_at<std::uint64_t>(json, "lost")};
}

const std::array<TopicRow, kTopics>& topic_table() {
  static const std::array<TopicRow, kTopics> table{{
      {Topic::Tick, "/heel/tick", "heel.Tick", [] { return flow_json_schema<TickRecord>("heel.Tick"); }},
      {Topic::Pose, "/heel/pose", "heel.Pose", [] { return flow_json_schema<PoseEstimate>("heel.Pose"); }},
      {Topic::Capture, "/heel/capture", "heel.Capture",
       [] { return flow_json_schema<CaptureCounters>("heel.Capture"); }},
      {Topic::Event, "/heel/event", "heel.Event", [] { return flow_json_schema<Event>("heel.Event"); }},
      {Topic::Wire, "/heel/wire", "heel.Wire", [] { return flow_json_schema<WireBytes>("heel.Wire"); }},
      {Topic::Timing, "/heel/timing", "heel.Timing",
       [] { return flow_json_schema<FrameTiming>("heel.Timing"); }},
      {Topic::Log, "/log", "foxglove.Log", log_schema},
      {Topic::Configuration, "/heel/configuration", "heel.Configuration",
       [] {
         return object_schema("heel.Configuration", {{"t_ns", kWhole}, {"number", kWhole}, {"text", kText}});
       }},
      {Topic::Operator, "/heel/operator", "heel.Operator",
       [] {
         return object_schema("heel.Operator",
                              {{"t_ns", kWhole}, {"who", kText}, {"request", kText}, {"answer", kText}});
       }},
      {Topic::Recording, "/heel/recording", "heel.Recording",
       [] {
         return object_schema("heel.Recording",
                              {{"t_ns", kWhole}, {"kind", kText}, {"text", kText}, {"lost", kWhole}});
       }},
      {Topic::Picture, "/camera", "foxglove.CompressedImage", picture_json_schema},
      {Topic::Transform, "/tf", "foxglove.FrameTransform", transform_json_schema},
      {Topic::Person, "/person", "foxglove.PoseInFrame", pose_in_frame_json_schema},
  }};
  return table;
}

}  // namespace heel
