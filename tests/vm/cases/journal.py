"""The journal has fields: the messages of a part, or of an event, can be selected."""


def run(bench):
    def told(match):
        return bench.guest.run(f"journalctl -u heeld -o cat --no-pager {match}").split("\n")

    lost = told("'HEEL_EVENT=camera lost'")
    bench.check(lost[0] and all(line.startswith("camera lost") for line in lost), "journalctl finds the lost cameras by their event")
    robot = told("HEEL_PART=robot")
    bench.check(any("motors enabled" in line for line in robot) and not any("camera" in line for line in robot),
                "and all that concerns the robot, and only that, by its part")
    warnings = told("-p warning")
    bench.check(any(line.startswith("camera lost") for line in warnings) and "following" not in warnings,
                "and warnings by their priority")
