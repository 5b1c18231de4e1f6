// The messages of /live, as JSON: docs/page.md lists their fields. Pictures have a head of JSON.
#pragma once

#include <optional>
#include <string>

#include "core/robot_geometry.h"
#include "heel/flow.h"
#include "logging/recent_log.h"
#include "operator/web/view_facts.h"
#include "operator/web/view_json.h"

namespace heel {

/// `wall_minus_monotonic_ns`: from the times of records to those of the clock on the wall.
std::string tick_message(const TickRecord& tick, const RobotGeometry& robot, TimeNs wall_minus_monotonic_ns);
std::string pose_message(const PoseEstimate& pose, const PoseMarks& marks,
                         std::optional<TimeNs> to_command_ns, const ViewFacts& facts);
std::string event_message(const LoggedLine& line, TimeNs wall_minus_monotonic_ns);
/// Without "type", as in /api/log.
ViewJson event_json(const LoggedLine& line, TimeNs wall_minus_monotonic_ns);
/// 4 bytes with the length of the head, the head, the JPEG bytes.
std::string picture_message(const FrameHeader& header, const std::string& jpeg, TimeNs now_ns);

}  // namespace heel
