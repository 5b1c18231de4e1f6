"""The virtual robot computer: two cores, a 16550, USB, a folder shared with the host.

Always emulated: KVM may be present and still be very slow. The processor has no AVX, which the emulator runs slowly."""
import os
import subprocess

from . import wait
from .agent import Agent
from .qmp import Qmp

BOOT_S = 240.0  # 15 s on an idle machine
TTY_S1 = "robot-line"  # QEMU's name of the 16550's other end


class Machine:
    """`folder` gets the sockets, the console's log and the shared folder; `image` is build/vm; `tty_s1` is the path of the pty
    at the other end of the guest's /dev/ttyS1."""

    def __init__(self, image, folder, tty_s1):
        self.folder = folder
        self.share = os.path.join(folder, "share")
        os.makedirs(self.share, exist_ok=True)
        self.console_log = os.path.join(folder, "console.log")
        self._process = subprocess.Popen(self._command(image, tty_s1), cwd=folder, stdin=subprocess.DEVNULL,
                                         stdout=open(os.path.join(folder, "qemu.log"), "wb"), stderr=subprocess.STDOUT)
        self.agent = None
        self._plugged = []

    def _command(self, image, tty_s1):
        return [
            "qemu-system-x86_64", "-accel", "tcg,thread=multi", "-cpu", "Nehalem", "-m", "1536", "-smp", "2",
            "-display", "none", "-nodefaults", "-no-reboot",
            "-kernel", f"{image}/kernel/vmlinuz", "-initrd", f"{image}/initramfs.zst",
            "-append", "console=ttyS0 root=/dev/vda rw panic=-1 mitigations=off quiet",
            "-drive", f"file={image}/disk.img,if=none,id=disk,format=raw,snapshot=on,cache=unsafe",
            "-device", "virtio-blk-pci,drive=disk", "-device", "virtio-rng-pci",
            "-virtfs", "local,path=share,mount_tag=share,security_model=none,multidevs=remap",
            "-device", "virtio-serial-pci",
            "-chardev", "socket,id=agent,path=agent.sock,server=on,wait=off",
            "-device", "virtserialport,chardev=agent,name=heel-vm",
            "-chardev", "file,id=console,path=console.log", "-serial", "chardev:console",
            "-chardev", f"serial,id={TTY_S1},path={tty_s1}", "-serial", f"chardev:{TTY_S1}",
            "-device", "qemu-xhci,id=usb", "-qmp", "unix:qmp.sock,server=on,wait=off",
        ]

    def wait_until_up(self):
        qmp = os.path.join(self.folder, "qmp.sock")
        wait.until("QEMU's sockets", lambda: os.path.exists(qmp) or self._ended(), 20)
        self.agent = Agent(os.path.join(self.folder, "agent.sock"))
        self.qmp = Qmp(qmp)
        self.agent.wait_until_up(BOOT_S)

    def _ended(self):
        if self._process.poll() is None:
            return False
        raise RuntimeError(f"QEMU ended with status {self._process.returncode}:\n{self._end_of('qemu.log')}")

    def plug_ftdi(self, name, pty, serial="HEEL0001"):
        """An FTDI adapter whose other end is `pty` (QEMU sets the pty's rate as the guest sets the adapter's)."""
        self.qmp.execute("chardev-add", id=f"{name}-line",
                         backend={"type": "serial", "data": {"device": pty}})
        self.qmp.execute("device_add", driver="usb-serial", id=name, bus="usb.0", chardev=f"{name}-line", serial=serial)
        self._plugged.append(name)

    def unplug_ftdi(self, name):
        self._plugged.remove(name)
        self.qmp.execute("device_del", id=name)
        wait.until(f"{name}: QEMU lets go of the line", lambda: self._chardev_removed(f"{name}-line"), 20)

    def unplug_all(self):
        for name in list(self._plugged):
            self.unplug_ftdi(name)

    def _chardev_removed(self, name):
        try:
            self.qmp.execute("chardev-remove", id=name)
            return True
        except RuntimeError:  # the device still has it
            return False

    def stop(self):
        """Ends at once: the disk is a temporary snapshot."""
        self._process.kill()
        self._process.wait()

    def _end_of(self, name, lines=60):
        try:
            with open(os.path.join(self.folder, name), errors="replace") as log:
                return "".join(log.readlines()[-lines:])
        except OSError as error:
            return str(error)

    def end_of_console(self):
        return self._end_of("console.log")
