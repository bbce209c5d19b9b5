#!/usr/bin/python3
"""make_seeds.py: writes the binary seeds of the fuzzers into test/fuzz/seeds (needs the package's messages)."""
import binascii
import pathlib
import struct

import rosbag
import rospy
from fsr_pressure_map.msg import MatrixFrame, MatrixInfo, SurfaceCurvature
from sensor_msgs.msg import FluidPressure, Temperature

SEEDS = pathlib.Path(__file__).parent / "seeds"


def crc16(data):
    """CRC-16/CCITT-FALSE."""
    crc = 0xFFFF
    for byte in data:
        crc ^= byte << 8
        for _ in range(8):
            crc = ((crc << 1) ^ 0x1021 if crc & 0x8000 else crc << 1) & 0xFFFF
    return crc


def packet(kind, sequence, time, payload):
    head = struct.pack("<BBHII", 1, kind, len(payload), sequence, time)
    head += struct.pack("<H", crc16(head))
    return b"\xA5\x5A" + head + payload + struct.pack("<I", binascii.crc32(head + payload))


def scan(sequence, counts):
    return packet(1, sequence, 10000 * sequence, struct.pack("<BBHI6H", 2, 3, 4095, 5000, *counts))


def write(target, name, data):
    folder = SEEDS / target
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_bytes(data)


def wire():
    scans = scan(1, range(6)) + scan(2, [4095] * 6)
    others = packet(2, 1, 10000, struct.pack("<i", 1200)) + packet(3, 1, 10000, struct.pack("<i", 23000))
    identity = packet(4, 1, 10000, b"FSR-0042".ljust(16, b"\0") + b"1.2.0".ljust(16, b"\0") + b"seed".ljust(16, b"\0")
                      + struct.pack("<BBHI", 2, 3, 4095, 10000))
    return scans + others + identity


def capture(data):
    return b"FSRCAP01" + struct.pack("<II", 115200, 0) + struct.pack("<qI", 10**18, len(data)) + data


def bag(path):
    with rosbag.Bag(str(path), "w", chunk_threshold=600) as out:
        for i in range(3):
            now = rospy.Time(1500000000 + i)
            messages = {
                "raw": MatrixFrame(sequence=i, device_time=i, rows=1, columns=2, full_scale=4095, counts=[i, 2 * i]),
                "chamber_pressure": FluidPressure(fluid_pressure=101325.0 + i),
                "temperature": Temperature(temperature=23.0),
                "matrix_info": MatrixInfo(serial="A", rows=1, columns=2, full_scale=4095, ambient_pressure=101325),
                "curvature": SurfaceCurvature(surface="flat", x=[0.0]),
            }
            for topic, message in messages.items():
                message.header.stamp = now
                out.write("/" + topic, message, now)


write("decoder", "every_type", wire())
write("decoder", "cut_and_again", wire()[:40] + wire())
write("capture", "every_type", capture(wire()))
(SEEDS / "bag").mkdir(parents=True, exist_ok=True)
bag(SEEDS / "bag" / "every_topic.bag")
write("table", "comma", b"\x01time,a,b\n0.1,2,3\n0.2,4,5\n")
write("table", "semicolon_and_decimal_comma", b"\x84t;p\r\n0,1;\"2,5\"\r\n# note\n0,2;3\r\n")
write("calibration_content", "numbers", struct.pack("<BBf", 0, 8, 1.5) + struct.pack("<BBf", 1, 9, float("nan")))
