#include "operator/web/view_facts.h"

#include "models/robot_models.h"

namespace heel {

const RobotModel& shown_robot(const RobotState& robot, const std::string& configured) {
  if (robot.kind.choice == ModelChoice::Chosen) return robot_models()[robot.kind.model];
  return robot_models()[index_of_model(configured).value_or(0)];
}

}  // namespace heel
