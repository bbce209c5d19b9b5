"""A case with a relaxation that is not of the library's form. The generator of blind cases has none.

The sheet feels p (1 - s): the load relaxes by a share s that follows a stretched exponential of its age (R. Kohlrausch, Ann. Phys.
167 (1854) 179), summed over all changes of the pressure (L. Boltzmann, Ann. Phys. 241 (1878) 430). `simulate` turns what the sheet
feels into readings, with curves, bending and noise; then the bags get the true chamber pressure.
"""

import pathlib
import subprocess

import numpy
import rosbag

SHARE, TIME, STRETCH = 0.08, 25.0, 0.6  # of the load in the end; [s]; 1 = a single time constant
RIG = """
simulation: relaxation
seed: 5
matrix: {rows: 4, columns: 6}
board: {scan_rate: 4, transducer_rate: 4}
program:
  - cycles: {peak: 500000, rate: 40000, dwell_peak: 8, cycles: 5}
  - cycles: {peak: 500000, rate: 10000, dwell_peak: 40, dwell_rest: 20, cycles: 4}
  - cycles: {peak: 300000, rate: 40000, dwell_peak: 8, cycles: 4}
session:
  - {surface: flat, flat: true}
  - {surface: cylinder_7cm, cylinder: {radius: 0.07, axis: y}, pause: 300}
effects:
  static_curve: {conductance: 3.0e-4, exponent: 0.85, conductance_scatter: 0.05}
  bending_preload: {amplitude: 30000}
  bending_gain: {change: -0.15}
  white_noise: {absolute: 10}
  converter: {}
"""


def felt(time, pressure):
    """Load of the sheet [Pa]."""
    rise = numpy.diff(pressure, prepend=pressure[0])
    relaxed = numpy.zeros_like(pressure)
    for i in numpy.flatnonzero(rise):
        relaxed[i:] += rise[i] * (1 - numpy.exp(-((time[i:] - time[i]) / TIME)**STRETCH))
    return pressure - SHARE * relaxed


def simulate(command, *words):
    subprocess.run([*command, *map(str, words)], check=True, capture_output=True)


def with_pressures(source, target, change):
    """Copies a bag; `change` gets the stamps [s] and chamber pressures [Pa] and returns new pressures."""
    with rosbag.Bag(str(source)) as bag, rosbag.Bag(str(target), "w") as copy:
        messages = list(bag.read_messages())
        readings = [message for topic, message, _ in messages if topic.endswith("chamber_pressure")]
        time = numpy.array([message.header.stamp.to_sec() for message in readings])
        pressures = change(time, numpy.array([message.fluid_pressure for message in readings]))
        for message, pressure in zip(readings, pressures):
            message.fluid_pressure = pressure
        for topic, message, stamp in messages:
            copy.write(topic, message, stamp)
    return pressures


def make(command, case):
    """Writes case/bags. `command`: that of `simulate`."""
    case = pathlib.Path(case)
    for folder in ("bags", "chamber", "felt", "read"):
        (case / folder).mkdir(parents=True, exist_ok=True)
    (case / "rig.yaml").write_text(RIG)
    simulate(command, "--simulation", case / "rig.yaml", "--output", case / "chamber")
    bags = sorted((case / "chamber").glob("*.bag"))
    true = []
    for bag in bags:
        def keep(_, pressure):
            true.append(pressure)
            return pressure
        with_pressures(bag, case / "bags" / bag.name, keep)
        with_pressures(bag, case / "felt" / bag.name, lambda time, p: p[0] + felt(time, p - p[0]))
    simulate(command, "--simulation", case / "rig.yaml", "--output", case / "read", "--drive",
             *sorted((case / "felt").glob("*.bag")))
    for bag, pressures in zip(bags, true):
        with_pressures(case / "read" / bag.name, case / "bags" / bag.name, lambda time, p, kept=pressures: kept)
