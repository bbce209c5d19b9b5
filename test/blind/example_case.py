#!/usr/bin/python3
"""Makes one case for scripts/score_cases. It uses nothing of the package but its message types.

    example_case.py CASE [none]        a sheet with a hidden loop, or, with `none`, with nothing hidden

The devel space of the package must be sourced, e.g. with `source out/devel/setup.bash`.
"""

import pathlib
import random
import sys

import rosbag
import rospy
import yaml
from fsr_pressure_map.msg import MatrixFrame, MatrixInfo, SurfaceCurvature
from sensor_msgs.msg import FluidPressure, Temperature

ROWS, COLUMNS, FULL_SCALE, RATE, AMBIENT = 4, 4, 4095, 10, 101325  # [Hz], [Pa]
SURFACES = {"flat": 0.0, "cylinder_7cm": 1 / 0.07}  # curvature along a row [1/m]
NOISE = 6  # white, of a reading [counts]
WIDTH = 0.08  # of the loop: unloading reads this share of the peak more at half the peak


def chamber(draw):
    """Pressures [Pa] at RATE: cycles whose peak and pace vary, with a pause at the peak, as in a chamber run by hand."""
    for _ in range(10):
        peak, ramp, dwell = draw.uniform(200e3, 400e3), draw.uniform(6, 20), draw.uniform(0, 5)
        steps = int(ramp * RATE)
        yield from ((peak * i / steps, +1, peak) for i in range(steps))
        yield from ((peak, +1, peak) for _ in range(int(dwell * RATE)))
        yield from ((peak * (1 - i / steps), -1, peak) for i in range(steps))
        yield from ((0.0, -1, peak) for _ in range(2 * RATE))


def felt(pressure, direction, peak, width):
    """The pressure that a taxel feels: more while unloading, most of all at half the peak."""
    if direction > 0:
        return pressure
    return pressure + width * peak * 4 * (pressure / peak) * (1 - pressure / peak)


def counts(pressure, curvature, gain, draw):
    """A power law of load and preload by bending, read by a divider, with white noise."""
    load = max(0.0, pressure + 800 * curvature) / 400e3
    reading = FULL_SCALE * gain * load**0.8 / (1 + load**0.8)
    return min(FULL_SCALE, max(0, round(reading + draw.gauss(0, NOISE))))


def write(bag, topic, stamp, message):
    message.header.stamp, message.header.frame_id = stamp, "fsr_matrix"
    bag.write("/fsr/" + topic, message, stamp)


def record(path, start, curvature, gains, width, draw):
    info = MatrixInfo(rows=ROWS, columns=COLUMNS, full_scale=FULL_SCALE, pitch_x=0.01, pitch_y=0.01,
                      ambient_pressure=AMBIENT, sensor_id="example")
    surface = SurfaceCurvature(surface=path.stem.split("_", 1)[1], mount=int(path.name[0]), x=[curvature])
    with rosbag.Bag(str(path), "w") as bag:
        for i, (pressure, direction, peak) in enumerate(chamber(draw)):
            stamp = rospy.Time.from_sec(start + i / RATE)
            if i % RATE == 0:
                write(bag, "matrix_info", stamp, info)
                write(bag, "curvature", stamp, surface)
                write(bag, "temperature", stamp, Temperature(temperature=23.0))
            write(bag, "chamber_pressure", stamp, FluidPressure(fluid_pressure=AMBIENT + pressure + draw.gauss(0, 100)))
            load = felt(pressure, direction, peak, width)
            write(bag, "raw", stamp, MatrixFrame(sequence=i, rows=ROWS, columns=COLUMNS, full_scale=FULL_SCALE,
                                                 counts=[counts(load, curvature, gain, draw) for gain in gains]))


def key(name, hidden):
    loop = {"id": "hysteresis", "form": "parabola", "snr": 6.9, "kpa_at_map": 8, "depends_on": ["direction", "pressure"],
            "where": {"taxels": "all", "conditions": "all", "pressure": [0, 400000], "direction": "both", "time": "all"},
            "parameters": [{"name": "width", "value": WIDTH, "unit": None, "library_parameter": None}]}
    told = {"id": "hysteresis", "could_be_told": True, "reason": None, "confused_with": []}
    return {"schema": 2, "case": name, "truth": "named" if hidden else "none", "set": "A", "protocol_class": "uneven_peaks",
            "effects": [loop] if hidden else [], "identifiable": {"effects": [told] if hidden else []},
            "sheet": {"rows": ROWS, "columns": COLUMNS, "bits": 12, "scan_rate": RATE}, "conditions": list(SURFACES)}


def main(folder, hidden):
    draw = random.Random(folder.name)  # the name alone decides
    (folder / "bags").mkdir(parents=True)
    gains = [draw.uniform(0.9, 1.1) for _ in range(ROWS * COLUMNS)]
    for i, (surface, curvature) in enumerate(SURFACES.items()):
        bag = folder / "bags" / ("%d_%s.bag" % (i + 1, surface))
        record(bag, 1.6e9 + 1000 * i, curvature, gains, WIDTH if hidden else 0, draw)
    (folder / "key.yaml").write_text(yaml.safe_dump(key(folder.name, hidden), sort_keys=False))


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]), sys.argv[2:] != ["none"])
