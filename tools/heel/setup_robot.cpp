// heel setup: the robot is found, and with consent its wheels turn.
#include <fmt/format.h>

#include <vector>

#include "device_list.h"
#include "robot/robot_address.h"
#include "setup_steps.h"

namespace heel::cli {
namespace {

/// Where a robot may be, the likeliest first.
std::vector<std::string> robot_addresses(const Setup& setup) {
  if (!setup.options.robot.empty()) {
    parse_robot_address(setup.options.robot);
    return {address_from_here(setup.options.robot)};
  }
  std::vector<std::string> addresses;
  const std::string& configured = setup.file.config().robot.address;
  if (setup.file.sets("robot.address")) addresses.push_back(configured);
  for (const std::string& path : serial_devices()) {
    const std::string address = fmt::format("serial:{}@{}", path, kDefaultBaud);
    if (addresses.empty() || address != addresses.front()) addresses.push_back(address);
  }
  return addresses;
}

}  // namespace

PreflightStep set_up_robot(Setup& setup) {
  PreflightStep step{.name = "robot"};
  const std::vector<std::string> addresses = robot_addresses(setup);
  if (addresses.empty())
    return step.fail("no USB serial line is there (/dev/heel-robot, /dev/ttyUSB*, /dev/ttyACM*)",
                     "connect the robot's cable, or say where it is: --robot serial:PATH or tcp:HOST:PORT");
  for (const std::string& address : addresses) {
    setup.dialogue.say(fmt::format("Asking at {} ... (all rates take 20 s at most)", address));
    Config wanted = setup.file.config();
    wanted.robot.address = address;
    step = check_robot(wanted);
    if (g_preflight_interrupted) return step;
    if (step.values.contains("robot")) {  // one answers there, also where it is not ready to drive
      setup.file.write(wanted);
      step.values["address"] = address;
      return step;
    }
    setup.dialogue.say("  " + step.measured);
  }
  if (addresses.size() > 1) step.measured = fmt::format("no robot at {} lines", addresses.size());
  return step;
}

PreflightStep set_up_wheels(Setup& setup) {
  const bool consented =
      setup.options.wheels_on_blocks || setup.dialogue.consents(
                                            "The wheels can turn now, slowly, for two seconds forwards and "
                                            "to the left. Only if the robot stands "
                                            "on blocks, all wheels off the floor, and a hand is at its STOP "
                                            "button: type blocks (Enter: not now)",
                                            "blocks");
  if (!consented)
    return {.name = "wheels",
            .verdict = StepVerdict::Skipped,
            .measured = "nothing was moved: lift the wheels off the floor, then --step wheels"};
  PreflightStep step = check_wheels(setup.file.config());
  if (step.verdict == StepVerdict::Pass && !g_preflight_interrupted &&
      !setup.dialogue.yes("Odometry says so. Did all wheels turn forwards, then the robot's left side back "
                          "and its right side forwards?",
                          true, "--yes"))
    step.fail(step.measured, "exchange the connectors of the wheels that turned the wrong way");
  return step;
}

}  // namespace heel::cli
