#include "control/follow_law_factory.h"

#include "control/proportional_law.h"
#include "control/trail_law.h"
#include "heel/error.h"

namespace heel {

std::unique_ptr<FollowLaw> make_follow_law(const Config& config) {
  const std::string& name = config.control.law;
  if (name == "view") return std::make_unique<ProportionalLaw>(config, YawGain::FromConfiguration);
  if (name == "position") return std::make_unique<ProportionalLaw>(config, YawGain::CancelsYaw);
  if (name == "trail") return std::make_unique<TrailLaw>(config);
  throw Error("control.law: '" + name + "' is not a control law (expected view, position or trail)");
}

}  // namespace heel
