#!/usr/bin/python3
"""make_seeds.py: writes the seeds of the fuzzers into test/fuzz/seeds (needs the package's messages)."""
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
    return scans + others + identity + packet(5, 1, 12345, struct.pack("<BI", 1, 2))


def capture(data):
    return b"FSRCAP01" + struct.pack("<II", 115200, 0) + struct.pack("<qI", 10**18, len(data)) + data


def calibration_content():
    """Inputs as calibration_content_fuzz.cpp and hdf5_damage.cpp read them: a valid file, then changes."""
    def change(how, thing, *fields):
        return struct.pack("<BB", how, thing) + b"".join(fields)

    attribute, value, dataset, gone = 0, 3, 6, 7
    text, number = 5 + 9 * 3, 4
    for scheme in range(4):
        write("calibration_content", f"sound_{scheme}", bytes([scheme]))
    write("calibration_content", "list_of_texts", b"\0" + change(attribute, 0, struct.pack("<BBBB", 4, text, 1, 100)))
    write("calibration_content", "text_for_a_number", b"\0" + change(attribute, 0, struct.pack("<BBBB", 2, text, 0, 0)))
    write("calibration_content", "nan", b"\3" + change(value, 30, struct.pack("<Hd", 1, float("nan"))))
    write("calibration_content", "huge", b"\1" + change(dataset, 30, struct.pack("<BBBB", number, 2, 230, 2)))
    write("calibration_content", "gone", b"\0" + change(gone, 9))


def saddle():
    """Triangles of a small saddle with edges of 0.5 mm, three corners each [mm]."""
    def corner(i, j):
        u, v = 0.5 * (i - 6), 0.5 * (j - 6)
        return (u, v, 0.01 * (u * u - v * v))

    for i in range(12):
        for j in range(12):
            a, b, c, d = corner(i, j), corner(i + 1, j), corner(i, j + 1), corner(i + 1, j + 1)
            yield a, b, d
            yield a, d, c


def mesh():
    """Inputs as mesh_fuzz.cpp reads them: a byte that chooses the ending, then the file."""
    stl, ply, obj = b"\0", b"\1", b"\2"
    faces = list(saddle())
    points = sorted({corner for face in faces for corner in face})
    numbers = [[points.index(corner) for corner in face] for face in faces]
    binary = struct.pack("<80xI", len(faces))
    for face in faces:
        binary += struct.pack("<12f2x", 0, 0, 0, *(value for corner in face for value in corner))
    write("mesh", "binary_stl", stl + binary)
    facets = "".join("facet normal 0 0 1\nouter loop\n" + "".join("vertex %g %g %g\n" % corner for corner in face)
                     + "endloop\nendfacet\n" for face in faces[:4])
    write("mesh", "text_stl", stl + f"solid part\n{facets}endsolid part\n".encode())
    head = (f"ply\nformat %s 1.0\nelement vertex {len(points)}\nproperty float x\nproperty float y\nproperty float z\n"
            f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n")
    write("mesh", "binary_ply", ply + (head % "binary_little_endian").encode()
          + b"".join(struct.pack("<3f", *point) for point in points)
          + b"".join(struct.pack("<B3i", 3, *face) for face in numbers))
    write("mesh", "text_ply", ply + (head % "ascii" + "".join("%g %g %g\n" % point for point in points)
                                     + "".join("3 %d %d %d\n" % tuple(face) for face in numbers)).encode())
    write("mesh", "obj", obj + ("".join("v %g %g %g\n" % point for point in points)
                                + "".join("f %d %d %d\n" % tuple(n + 1 for n in face) for face in numbers)).encode())
    write("mesh", "obj_with_polygon", obj + b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1 -1//1\n")


def bag(name, packing="none"):
    folder = SEEDS / "bag"
    folder.mkdir(parents=True, exist_ok=True)
    with rosbag.Bag(str(folder / name), "w", compression=packing, chunk_threshold=600) as out:
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
write("text", "comma_and_header", b"\x000,1\r\ntime,a,b,c\r\n# note\r\n#trigger,12,1,1\r\n12,0,512,1023\r\n13,9,8,7\r\n")
write("text", "blanks_and_transducer", b"\x02\n12 0  512 1023 -70000 \n13\t9\t8\t7\t6\n14; 1; 2; 3; 4;\n")
write("text", "seven_by_ten", b"\x01\n" + b"".join(b"%d," % number for number in range(71)) + b"\n")
write("capture", "every_type", capture(wire()))
bag("every_topic.bag")
bag("packed_by_bz2.bag", "bz2")
bag("packed_by_lz4.bag", "lz4")
for number, use in enumerate(("check_bag", "socket", "scrub", "csv", "hdf5", "tekscan", "train")):
    write("tools", use, bytes([number]) + (SEEDS / "bag" / "every_topic.bag").read_bytes())
write("tools", "table", b"\x07t,a,p\n0,100,1\n0.1,200,2\n0.2,4095,3\n")
write("table", "comma", b"\x01time,a,b\n0.1,2,3\n0.2,4,5\n")
write("table", "semicolon_and_decimal_comma", b"\x84t;p\r\n0,1;\"2,5\"\r\n# note\n0,2;3\r\n")
calibration_content()
mesh()
write("tare", "two_taxels", b"format: fsr_pressure_map tare 1\ncalibration: 3f2a\nsurface: flat\nmount: 2\ncurvature: 0\n"
      b"date: 2024-05-17T09:30:00Z\nrows: 1\ncolumns: 2\noffset: [1.5, -20]\n")
write("recording", "three_columns", b"\x00t,a,p\n0,100,1\n0.1,200,2\n0.2,4095,3\n")
write("recording", "units", b"\x02t,a,b,p,k\n0,0.5,1,20,293\n100,1,2,40,294\n")
write("recording", "surfaces", b"\x05t;r;p;s;c;m\n0;10;1;flat;0;1\n1000;inf;2;bent;0.2;1\n2000;7;3;bent;0.2;2\n")
write("surface", "list_as_a_key", b"surface: flat\nflat: true\n? [a, b]\n: 1\n")
