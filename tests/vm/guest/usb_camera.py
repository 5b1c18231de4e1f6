#!/usr/bin/python3
"""A USB camera without hardware: a UVC 1.0 bulk camera behind the kernel's virtual host controller (vhci_hcd, USB/IP), so that
the kernel's own uvcvideo driver is what heeld talks to. Shows one picture over and over.

  usb_camera.py PICTURE.pgm RATE_HZ        attaches at once; detaches when it ends (SIGTERM); SIGSTOP makes it stall
"""
import select
import socket
import struct
import sys
import time

ATTACH = "/sys/devices/platform/vhci_hcd.0/attach"
HIGH_SPEED = 3
DEVICE_ID = 0x10001
VIDEO_ENDPOINT = 1
EPIPE, ECONNRESET = 32, 104  # a refused request; one that was taken back

CMD_SUBMIT, CMD_UNLINK, RET_SUBMIT, RET_UNLINK = 1, 2, 3, 4
HEADER_BYTES = 48
GET_DESCRIPTOR, GET_STATUS = 6, 0
PROBE, COMMIT = 1, 2
SET_CUR, GET_CUR, GET_MIN, GET_MAX, GET_LEN, GET_INFO, GET_DEF = 0x01, 0x81, 0x82, 0x83, 0x85, 0x86, 0x87
PAYLOAD_HEADER_BYTES = 2
END_OF_FRAME = 0x82  # and that the header ends here; bit 0 alternates from frame to frame

YUY2 = b"YUY2" + bytes.fromhex("00001000800000aa00389b71")


def read_pgm(path):
    """Returns width, height and grey bytes of a binary PGM with 8 bits."""
    with open(path, "rb") as file:
        data = file.read()
    kind, width, height, depth = data.split(maxsplit=4)[:4]
    if kind != b"P5" or depth != b"255":
        sys.exit(f"{path}: not a binary 8-bit PGM (expected P5 … 255)")
    width_px, height_px = int(width), int(height)
    return width_px, height_px, data[len(data) - width_px * height_px:]


def descriptor(kind, body):
    return bytes([len(body) + 2, kind]) + body


def video_control(subtype, body):
    return descriptor(0x24, bytes([subtype]) + body)


class Descriptors:
    def __init__(self, width_px, height_px, interval_100ns):
        self.device = descriptor(1, struct.pack("<HBBBBHHHBBBB", 0x0200, 0xEF, 2, 1, 64, 0x1D6B, 0x0102, 0x0100, 1, 2, 3, 1))
        self.strings = ["", "heel", "heel test camera", "0001"]
        self.configuration = self._configuration(width_px, height_px, interval_100ns)

    def string(self, index):
        return descriptor(3, struct.pack("<H", 0x0409) if index == 0 else self.strings[index].encode("utf-16-le"))

    def _configuration(self, width_px, height_px, interval_100ns):
        control = (video_control(0x02, struct.pack("<BHBBHHHB", 1, 0x0201, 0, 0, 0, 0, 0, 3) + bytes(3))  # a camera …
                   + video_control(0x03, struct.pack("<BHBBB", 2, 0x0101, 0, 1, 0)))                      # … seen over USB
        control_header = video_control(0x01, struct.pack("<HHIBB", 0x0100, 13 + len(control), 48_000_000, 1, 1))
        bits_per_s = width_px * height_px * 16 * 10_000_000 // interval_100ns
        frame_bytes = width_px * height_px * 2
        formats = (video_control(0x04, bytes([1, 1]) + YUY2 + bytes([16, 1, 0, 0, 0, 0]))
                   + video_control(0x05, struct.pack("<BBHHIIIIBI", 1, 0, width_px, height_px, bits_per_s, bits_per_s,
                                                     frame_bytes, interval_100ns, 1, interval_100ns))
                   + video_control(0x0D, bytes([1, 1, 4])))
        formats_header = video_control(0x01, struct.pack("<BHBBBBBBBB", 1, 14 + len(formats), 0x80 | VIDEO_ENDPOINT, 0, 2,
                                                         0, 0, 0, 1, 0))
        body = (descriptor(0x0B, bytes([0, 2, 0x0E, 3, 0, 2]))
                + descriptor(4, bytes([0, 0, 0, 0x0E, 1, 0, 2])) + control_header + control
                + descriptor(4, bytes([1, 0, 1, 0x0E, 2, 0, 0])) + formats_header + formats
                + descriptor(5, struct.pack("<BBHB", 0x80 | VIDEO_ENDPOINT, 2, 512, 0)))
        return descriptor(2, struct.pack("<HBBBBB", 9 + len(body), 2, 1, 0, 0x80, 50)) + body


class Camera:
    def __init__(self, picture, rate_hz):
        width_px, height_px, grey = picture
        self.period_s = 1.0 / rate_hz
        interval_100ns = int(10_000_000 / rate_hz)
        self.descriptors = Descriptors(width_px, height_px, interval_100ns)
        self.picture = bytes(byte for value in grey for byte in (value, 128))
        size = len(self.picture)
        self.probe = struct.pack("<HBBIHHHHHII", 1, 1, 1, interval_100ns, 0, 0, 0, 0, 0, size, size + PAYLOAD_HEADER_BYTES)
        self.waiting = []  # (sequence number, bytes) of transfers the host has asked for
        self.frame = b""   # what is left of the frame being sent
        self.toggle = 0
        self.socket = self._attach()

    def _attach(self):
        ours, kernels = socket.socketpair()
        ours.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 1 << 20)
        with open(ATTACH, "w") as attach:
            attach.write(f"0 {kernels.fileno()} {DEVICE_ID} {HIGH_SPEED}")
        return ours  # the kernel keeps its own hold of the other end

    def run(self):
        next_s = time.monotonic()
        while True:
            now_s = time.monotonic()
            if now_s >= next_s:
                next_s = max(next_s + self.period_s, now_s)
                if not self.frame and self.waiting:
                    self.toggle ^= 1
                    self.frame = bytes([PAYLOAD_HEADER_BYTES, END_OF_FRAME | self.toggle]) + self.picture
            self._send_frame()
            readable, _, _ = select.select([self.socket], [], [], max(0.0, next_s - time.monotonic()))
            if readable:
                self._take_request()

    def _send_frame(self):
        while self.frame and self.waiting:
            sequence, room = self.waiting.pop(0)
            part, self.frame = self.frame[:room], self.frame[room:]
            self._complete(sequence, 0, part)

    def _take_request(self):
        header = self._read(HEADER_BYTES)
        command, sequence, _, is_in, endpoint = struct.unpack(">5I", header[:20])
        if command == CMD_UNLINK:
            self._unlink(sequence, struct.unpack(">I", header[20:24])[0])
            return
        size = struct.unpack(">I", header[24:28])[0]
        if not is_in and size:
            self._read(size)
        if endpoint == VIDEO_ENDPOINT:
            self.waiting.append((sequence, size))
        else:
            self._control(sequence, header[40:48], size)

    def _control(self, sequence, setup, size):
        kind, request, value, index, length = struct.unpack("<BBHHH", setup)
        answer = self._standard(request, value) if kind & 0x60 == 0 else self._video(request, value, index)
        if answer is None:
            self._complete(sequence, -EPIPE, b"")
        elif kind & 0x80:
            self._complete(sequence, 0, answer[:length])
        else:
            self._complete(sequence, 0, b"", size)

    def _standard(self, request, value):
        if request == GET_DESCRIPTOR:
            kind, index = value >> 8, value & 0xFF
            if kind == 3:
                return self.descriptors.string(index)
            return {1: self.descriptors.device, 2: self.descriptors.configuration}.get(kind)
        return b"\0\0" if request == GET_STATUS else b""

    def _video(self, request, value, index):
        if index & 0xFF != 1 or value >> 8 not in (PROBE, COMMIT):
            return None
        if request in (SET_CUR, GET_CUR, GET_MIN, GET_MAX, GET_DEF):
            return self.probe  # one format, one size, one rate: whatever is proposed
        return {GET_LEN: bytes([len(self.probe), 0]), GET_INFO: b"\3"}.get(request)

    def _unlink(self, sequence, unlinked):
        found = any(number == unlinked for number, _ in self.waiting)
        self.waiting = [entry for entry in self.waiting if entry[0] != unlinked]
        if found:
            self.frame = b""
        self.socket.sendall(struct.pack(">6I", RET_UNLINK, sequence, 0, 0, 0, (-ECONNRESET if found else 0) & 0xFFFFFFFF)
                            + bytes(24))

    def _complete(self, sequence, status, data, written=0):
        self.socket.sendall(struct.pack(">IIIIIiiIII", RET_SUBMIT, sequence, 0, 0, 0, status, len(data) or written, 0, 0, 0)
                            + bytes(8) + data)

    def _read(self, size):
        data = b""
        while len(data) < size:
            part = self.socket.recv(size - len(data))
            if not part:
                sys.exit(0)  # detached by the host
            data += part
        return data


def main():
    if len(sys.argv) != 3:
        sys.exit("usage: usb_camera.py PICTURE.pgm RATE_HZ")
    Camera(read_pgm(sys.argv[1]), float(sys.argv[2])).run()


main()
