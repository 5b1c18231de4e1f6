// The topics of a recording and the schemas of their messages. Messages are JSON.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace heel {

enum class Topic : std::uint8_t {
  Tick,           ///< TickRecord
  Pose,           ///< PoseEstimate
  Capture,        ///< CaptureCounters
  Event,          ///< Event
  Wire,           ///< WireBytes
  Timing,         ///< FrameTiming
  Log,            ///< LogLine
  Configuration,  ///< ConfigurationText
  Operator,       ///< OperatorLine
  Recording,      ///< RecordingNote
  Picture,        ///< RecordedPicture
  Transform,      ///< for viewers: where the robot is
  Person,         ///< for viewers: where the person is
};
inline constexpr std::size_t kTopics = 13;

struct TopicRow {
  Topic topic;
  std::string_view name;
  std::string_view schema;
  std::string (*schema_text)();
};
/// In the order of Topic.
const std::array<TopicRow, kTopics>& topic_table();

}  // namespace heel
