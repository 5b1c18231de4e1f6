"""Everything that vivid can do wrong: refused calls, damaged and dropped buffers, stalls, counters that wrap, a dead device."""
from cases.appearing import VIVID
from vm.bench import CAMERA_REST_S

WRAP_S = 20.0  # vivid's wrap comes 13 or 16 s after the start of streaming


def control(setting):
    return f"v4l2-ctl -d /dev/video0 -c {setting}"


FATAL = control("inject_fatal_streaming_error=1")


def run(bench):
    service, robot = bench.service, bench.robots["16550"]
    bench.guest.run(VIVID)
    service.configure(camera="v4l2:/dev/video0", robot="serial:/dev/ttyS1@38400")
    service.start()
    service.wait_until_ready()

    def opened_anew(name, cause, told, **more):
        begin_s = bench.in_guest("true")
        bench.blip("vivid", name, robot, cause, rest_at_most_s=CAMERA_REST_S, **more)
        bench.check(service.events(told, begin_s), f"heeld has told: {told}")

    opened_anew("fatal streaming error", FATAL, "gives no frame: Input/output error")
    # The other calls are made when the camera is opened anew, and the fatal error makes heeld do so.
    opened_anew("VIDIOC_REQBUFS refused once", f"{control('inject_vidioc_reqbufs_error=1')} && {FATAL}", "gives no buffers")
    opened_anew("VIDIOC_STREAMON refused once", f"{control('inject_vidioc_streamon_error=1')} && {FATAL}",
                "does not start streaming")
    opened_anew("VIDIOC_QBUF refused once", control("inject_vidioc_qbuf_error=1"), "takes no buffer back")
    opened_anew("disconnected", control("disconnect=1"), "gives no frame: No such device")
    opened_anew("one buffer flagged as damaged", control("inject_v4l2_buf_flag_error=1"), "damaged")
    bench.blip("vivid", "half of the buffers dropped", robot, control("percentage_of_dropped_buffers=50"),
               cure=control("percentage_of_dropped_buffers=0"))
    # Counters and clocks that begin shortly before their end, from the next start of streaming on.
    opened_anew("the sequence number wraps", f"{control('wrap_sequence_number=1')} && {FATAL}", "camera opened",
                cure=control("wrap_sequence_number=0"), lasts_s=WRAP_S)
    for bits, choice in ((64, 1), (32, 2)):
        opened_anew(f"the time stamp wraps at {bits} bits", f"{control(f'wrap_timestamp={choice}')} && {FATAL}", "camera opened",
                    cure=control("wrap_timestamp=0"), lasts_s=WRAP_S)
    bench.fault("vivid", "stalled (all buffers dropped), goes on", robot, control("percentage_of_dropped_buffers=100"),
                cure=control("percentage_of_dropped_buffers=0"), rest_within_s=CAMERA_REST_S)
    service.stop()
    bench.guest.run("modprobe -r vivid")
