#include "control/follow_law_factory.h"

#include "control/proportional_law.h"
#include "heel/error.h"

namespace heel {

std::unique_ptr<FollowLaw> make_follow_law(const Config& config) {
  const std::string& name = config.control.law;
  if (name == "view") return std::make_unique<ProportionalLaw>(config, YawGain::FromConfiguration);
  if (name == "position") return std::make_unique<ProportionalLaw>(config, YawGain::CancelsYaw);
  throw Error("control.law: '" + name + "' is not a control law (expected view or position)");
}

}  // namespace heel
