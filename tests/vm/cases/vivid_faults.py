"""Every fault that vivid can produce: refused calls, damaged and dropped buffers, stalls, counters that wrap, a lost device."""
from cases.appearing import VIVID
from vm.bench import CAMERA_REST_S

WRAP_S = 20.0  # vivid's wrap comes 13 or 16 s after the start of streaming
RATE_HZ = 10.0
FEWEST_DROPPED = 8  # of forty pictures in four seconds, half are dropped; the emulated driver may come to fewer of both


def control(setting):
    return f"v4l2-ctl -d /dev/video0 -c {setting}"


FATAL = control("inject_fatal_streaming_error=1")


def run(bench):
    service, robot = bench.service, bench.robots["16550"]
    bench.guest.run(VIVID)
    service.configure(camera="v4l2:/dev/video0", robot="serial:/dev/ttyS1@38400")
    service.start()
    service.wait_until_ready()

    def told_and_counted(name, cause, told, reopened=1, **more):
        begin_s = bench.in_guest("true")
        row = bench.blip("vivid", name, robot, cause, rest_at_most_s=CAMERA_REST_S, **more)
        bench.check(service.events(told, begin_s), f"heeld has told: {told}")
        bench.check(row["camera_reopened"] == reopened, f"and counted: the camera was opened again {reopened} times")
        return row["frames_dropped_by_driver"]

    told_and_counted("fatal streaming error", FATAL, "gives no frame: Input/output error")
    # The other calls are made when the camera is opened again, and the fatal error makes heeld do so.
    told_and_counted("VIDIOC_REQBUFS refused once", f"{control('inject_vidioc_reqbufs_error=1')} && {FATAL}", "gives no buffers")
    told_and_counted("VIDIOC_STREAMON refused once", f"{control('inject_vidioc_streamon_error=1')} && {FATAL}",
                     "does not start streaming")
    told_and_counted("VIDIOC_QBUF refused once", control("inject_vidioc_qbuf_error=1"), "takes no buffer back")
    told_and_counted("disconnected", control("disconnect=1"), "gives no frame: No such device")
    lost = told_and_counted("one buffer flagged as damaged", control("inject_v4l2_buf_flag_error=1"), "damaged", reopened=0)
    bench.check(lost >= 1, "and the damaged frame")
    row = bench.blip("vivid", "half of the buffers dropped", robot, control("percentage_of_dropped_buffers=50"),
                     cure=control("percentage_of_dropped_buffers=0"))
    bench.check(row["frames_dropped_by_driver"] >= FEWEST_DROPPED, f"at least {FEWEST_DROPPED} of them are counted")
    # Counters and clocks that start shortly before they wrap, when streaming starts the next time.
    lost = told_and_counted("the sequence number wraps", f"{control('wrap_sequence_number=1')} && {FATAL}", "camera opened",
                            cure=control("wrap_sequence_number=0"), lasts_s=WRAP_S)
    bench.check(lost < WRAP_S * RATE_HZ, "and no frames that never were")
    for bits, choice in ((64, 1), (32, 2)):
        told_and_counted(f"the time stamp wraps at {bits} bits", f"{control(f'wrap_timestamp={choice}')} && {FATAL}", "camera opened",
                         cure=control("wrap_timestamp=0"), lasts_s=WRAP_S)
    bench.fault("vivid", "stalled (all buffers dropped), goes on", robot, control("percentage_of_dropped_buffers=100"),
                cure=control("percentage_of_dropped_buffers=0"), rest_within_s=CAMERA_REST_S)
    service.stop()
    bench.guest.run("modprobe -r vivid")
