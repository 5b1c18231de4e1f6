"""libcamera with its test camera vimc: heeld follows its pictures; its driver is unbound and bound again; unknown names are refused."""
from cases.install import CAMERA_INFO
from vm.bench import CAMERA_REST_S
from vm.service import START_S

CAMERA = "libcamera:platform/vimc.0 Sensor B"
DRIVER = "/sys/bus/platform/drivers/vimc"
SIZE = {"width_px": 324, "height_px": 180}  # vimc's widths are multiples of twelve
ROI = "10,10,300,160"


def run(bench):
    guest, service, robot = bench.guest, bench.service, bench.robots["16550"]
    guest.run("modprobe vimc")
    service.install("vimc.yaml", CAMERA_INFO.replace("image_width: 320", "image_width: 324").encode())
    told = guest.run(f"heel teach --camera '{CAMERA}' --frame 2 --roi {ROI} --distance 2 --max 150 --camera-info /etc/heel/vimc.yaml "
                     "-o /etc/heel/vimc.heel")
    bench.check("wrote" in told, "heel teach makes a template of its picture")

    configure(service, "libcamera:nobody")
    begin_s = bench.in_guest("true")
    service.start()
    bench.wait("a camera that libcamera does not know is refused, and those it knows are named",
               lambda: f"knows no camera of this id; it knows {CAMERA.split(':')[1]}" in service.journal_since(begin_s), START_S)
    service.stop()

    configure(service, CAMERA)
    begin_s = bench.in_guest("true")
    service.start()
    service.wait_until_ready()
    opened = service.events("camera opened", begin_s)
    bench.check(any(f"{SIZE['width_px']}x{SIZE['height_px']}-" in line for line in opened), f"a format is agreed on: {opened}")
    # libcamera cannot release a camera that failed: heeld shuts down normally, and systemd starts it again.
    bench.fault("libcamera, vimc", "unbound, bound", robot, cause=f"echo vimc.0 >{DRIVER}/unbind", cure=f"echo vimc.0 >{DRIVER}/bind",
                rest_within_s=CAMERA_REST_S)
    journal = service.journal_since(begin_s)
    bench.check("only in a new process" in journal and "heeld stopped" in journal, "heeld has shut down normally, with the reason")
    service.stop()
    guest.run("modprobe -r vimc")


def configure(service, camera):
    service.configure(camera=camera, robot="serial:/dev/ttyS1@38400", info="vimc.yaml", shirt="vimc.heel", **SIZE)
