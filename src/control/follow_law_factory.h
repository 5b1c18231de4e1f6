// Makes the control law that the configuration names.
#pragma once

#include <memory>

#include "control/follow_law.h"
#include "core/config.h"

namespace heel {

/// Throws heel::Error when `config.control.law` is not a law.
std::unique_ptr<FollowLaw> make_follow_law(const Config& config);

}  // namespace heel
