#include "manual.h"

namespace heel::sim {

commandline::ProgramText heel_sim_manual() {
  commandline::ProgramText text;
  text.name = "heel-sim";
  text.summary = "a simulated P3-AT for any ARCOS client, with a person to follow and a camera";
  text.description =
      "It plays a robot of the Pioneer family on a pty or a TCP port, in real time, with faults on request. "
      "With a "
      "scenario it also simulates a walking person, and draws what the robot's camera sees. Events and "
      "progress are "
      "lines on standard output. It ends on SIGINT or SIGTERM.";
  text.exit_statuses = {{0, "done, or ended by a signal"},
                        {kExitInput, "a file, an address or a device cannot be used"},
                        {kExitUsage, "bad usage"}};
  text.commands[""] = {
      {{"heel-sim --robot pty:/tmp/p3at", "a robot alone, for a client that opens pty:/tmp/p3at"},
       {"heel-sim --robot tcp:8101 --fault silence@20+5", "on a TCP port; silent from 20 s to 25 s"},
       {"heel-sim --robot pty:/tmp/p3at --scenario walk.toml --camera sim:walk --truth truth.csv",
        "with a person, and the camera sim:walk for heeld"},
       {"heel-sim --scenario walk.toml --still view.png --camera-info-out camera.yaml",
        "what `heel teach` needs, without a robot"}},
      {}};
  text.files = {{"/usr/share/heel/scenarios", "Scenarios to begin with."}};
  text.see_also = {"heel(1)", "heeld(8)"};
  return text;
}

}  // namespace heel::sim
