#!/usr/bin/python3
"""Feeds a v4l2loopback device with a picture, over and over, until it is ended. The file is read each time: replacing
it shows a film.

  loopback_camera.py DEVICE PICTURE.pgm|PICTURE.jpg RATE_HZ
"""
import fcntl
import struct
import sys
import time

VIDIOC_S_FMT = 0xC0D05605
V4L2_BUF_TYPE_VIDEO_OUTPUT = 2
V4L2_FIELD_NONE = 1
FORMAT_BYTES = 208  # struct v4l2_format on 64-bit systems: the type, padding, a union


def read_picture(path):
    """Its format as V4L2 names it, size, bytes of a row, and what a frame of it consists of."""
    with open(path, "rb") as file:
        data = file.read()
    if data.startswith(b"P5"):
        width_px, height_px = (int(field) for field in data.split(maxsplit=3)[1:3])
        return b"GREY", width_px, height_px, width_px, data[len(data) - width_px * height_px:]
    height_px, width_px = struct.unpack_from(">HH", data, data.index(b"\xff\xc0") + 5)  # of the start of the frame
    return b"MJPG", width_px, height_px, 0, data


def main():
    device, path, rate_hz = sys.argv[1], sys.argv[2], float(sys.argv[3])
    name, width_px, height_px, stride, frame = read_picture(path)
    largest = max(len(frame), 2 * width_px * height_px)
    pixels = struct.pack("<6I", width_px, height_px, int.from_bytes(name, "little"), V4L2_FIELD_NONE, stride, largest)
    request = struct.pack("<II", V4L2_BUF_TYPE_VIDEO_OUTPUT, 0) + pixels
    with open(device, "r+b", buffering=0) as output:
        fcntl.ioctl(output, VIDIOC_S_FMT, request.ljust(FORMAT_BYTES, b"\0"))
        while True:
            output.write(read_picture(path)[-1])
            time.sleep(1.0 / rate_hz)


main()
