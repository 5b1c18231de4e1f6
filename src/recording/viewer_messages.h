// What viewers draw of a run without knowing heel, in Foxglove's stock schemas: where the robot is and where
// the person is. Made of the ticks; nothing reads them back.
#pragma once

#include <string>

#include "heel/flow.h"

namespace heel {

/// foxglove.FrameTransform from "odom" to "robot". Appends nothing before the first packet of the robot.
void append_robot_transform(std::string& json, const TickRecord& tick, TimeNs t_log_ns);
/// foxglove.PoseInFrame in "robot": the back, turned to the direction of travel. Appends nothing while the
/// target is not known.
void append_person_pose(std::string& json, const TickRecord& tick, TimeNs t_log_ns);

std::string transform_json_schema();
std::string pose_in_frame_json_schema();

}  // namespace heel
