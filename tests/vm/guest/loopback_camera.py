#!/usr/bin/python3
"""Feeds a v4l2loopback device with one picture, over and over, until it is ended.

  loopback_camera.py DEVICE PICTURE.pgm RATE_HZ
"""
import fcntl
import struct
import sys
import time

VIDIOC_S_FMT = 0xC0D05605
V4L2_BUF_TYPE_VIDEO_OUTPUT = 2
V4L2_FIELD_NONE = 1
GREY = int.from_bytes(b"GREY", "little")
FORMAT_BYTES = 208  # struct v4l2_format on 64-bit systems: the type, padding, a union


def read_pgm(path):
    with open(path, "rb") as file:
        data = file.read()
    width_px, height_px = (int(field) for field in data.split(maxsplit=3)[1:3])
    return width_px, height_px, data[len(data) - width_px * height_px:]


def main():
    device, picture, rate_hz = sys.argv[1], sys.argv[2], float(sys.argv[3])
    width_px, height_px, grey = read_pgm(picture)
    pixels = struct.pack("<6I", width_px, height_px, GREY, V4L2_FIELD_NONE, width_px, len(grey))
    request = struct.pack("<II", V4L2_BUF_TYPE_VIDEO_OUTPUT, 0) + pixels
    with open(device, "r+b", buffering=0) as output:
        fcntl.ioctl(output, VIDIOC_S_FMT, request.ljust(FORMAT_BYTES, b"\0"))
        while True:
            output.write(grey)
            time.sleep(1.0 / rate_hz)


main()
