"""Recomputes the gap of a verdict: rms(measured - simulated) over the hold-out cycles that verdict.yaml names.

The simulated readings are those of `simulate --drive` with the written base.yaml (before) and simulation.yaml (after), without
what is random. All bags are driven, because a sheet remembers what it went through; only the hold-out cycles are compared.
"""

import json
import pathlib
import re
import shutil
import struct
import subprocess

import numpy

FRAME, INFO = "fsr_pressure_map/MatrixFrame", "fsr_pressure_map/MatrixInfo"
ROUNDING = 1000  # of stamps that YAML reads as floating point numbers [ns]
BLOCK = r"^  (?:%s):.*\n(?:(?:    .*|\s*)\n)*"
WHITE_NOISE = re.compile(BLOCK % "white_noise", re.MULTILINE)
RANDOM = re.compile(BLOCK % "mains_pickup|repositioning|row_fault|column_fault", re.MULTILINE)  # lines: unless their spells are known
WALKS = re.compile(r"^(    (?:rate|zero)_walk:).*$", re.MULTILINE)


class NotRecomputable(Exception):
    """One phrase that says why."""


def run_program(words, **options):
    """Runs a program in a session of its own: Ctrl-C in the terminal stops the script, which waits for programs that run."""
    return subprocess.run(words, capture_output=True, text=True, start_new_session=True, **options)


class Scans:
    """The scans of one bag: stamps [ns], counts [scans x taxels], full scale, and which taxels are in use."""

    def __init__(self, path):
        import rosbag  # not above: it takes longer than all else that the scripts import
        self.path = pathlib.Path(path)
        stamps, rows, self.full_scale, mask = [], [], None, b""
        with rosbag.Bag(str(path)) as bag:
            types = {c.topic: c.datatype for c in bag._get_connections()}
            topics = sorted(topic for topic, kind in types.items() if kind == FRAME and topic.endswith("raw"))
            if len(topics) != 1:
                raise NotRecomputable("%s holds %d topics `raw`, but must hold one" % (self.path.name, len(topics)))
            for _, (_, data, *_), _ in bag.read_messages(topics=topics, raw=True):
                stamp, self.full_scale, counts = frame(data)
                stamps.append(stamp)
                rows.append(counts)
            info = topics[0][:-len("raw")] + "matrix_info"
            for _, message, _ in bag.read_messages(topics=[info]):
                mask = message.mask
                break
        if not rows:
            raise NotRecomputable("%s holds no scan" % self.path.name)
        self.stamps, first = numpy.unique(numpy.array(stamps, dtype=numpy.int64), return_index=True)
        self.counts = numpy.array(rows, dtype=numpy.float64)[first]
        masked = numpy.frombuffer(bytes(mask), dtype=numpy.uint8)
        self.used = masked == 0 if masked.size == self.counts.shape[1] else numpy.ones(self.counts.shape[1], dtype=bool)


def frame(data):
    """Stamp [ns], full scale and counts of a serialised MatrixFrame."""
    _, seconds, nanoseconds, length = struct.unpack_from("<IIII", data)
    at = 16 + length + 4 + 8 + 4  # header, sequence, device_time, scan_duration
    _, _, full_scale, number = struct.unpack_from("<HHHI", data, at)
    return seconds * 10**9 + nanoseconds, full_scale, numpy.frombuffer(data, dtype="<u2", count=number, offset=at + 10)


def quiet_copy(simulation, folder):
    """The simulation file without white_noise, with its table of curves beside it."""
    folder.mkdir(parents=True, exist_ok=True)
    for table in simulation.parent.glob("*_curves.csv"):
        shutil.copy(table, folder)
    copy = folder / simulation.name
    copy.write_text(WHITE_NOISE.sub("", simulation.read_text()))
    return copy


def expected_copy(simulation, folder):
    """The same without whatever else is random."""
    copy = quiet_copy(simulation, folder)
    text = RANDOM.sub(lambda effect: effect[0] if "spells:" in effect[0] else "", copy.read_text())
    copy.write_text(WALKS.sub(r"\1 0", text))
    return copy


def runs_in_time_order(bags):
    """Bags in order of time; one that begins before the last one has ended starts a run of its own, with a fresh sheet."""
    runs, end = [], None
    for bag in sorted(bags, key=lambda b: b.stamps[0]):
        if end is None or bag.stamps[0] <= end:
            runs.append([])
        runs[-1].append(bag)
        end = bag.stamps[-1]
    return runs


def drive(command, simulation, run, folder, environment):
    words = [*command, "--simulation", str(simulation), "--output", str(folder), "--drive", *(str(b.path) for b in run)]
    done = run_program(words, env=environment)
    if done.returncode != 0:
        raise NotRecomputable("simulate: " + (done.stderr.strip().splitlines() or ["status %d" % done.returncode])[-1])
    return [Scans(folder / b.path.name) for b in run]


def within(stamps, cycles):
    chosen = numpy.zeros(stamps.size, dtype=bool)
    for first, last in cycles:
        chosen |= (stamps >= round(first * 1e9) - ROUNDING) & (stamps <= round(last * 1e9) + ROUNDING)
    return chosen


def squares(measured, simulated, cycles):
    """Sum of squared differences [share of full scale, squared], and the number of scans and of readings."""
    common, i, j = numpy.intersect1d(measured.stamps, simulated.stamps, assume_unique=True, return_indices=True)
    chosen = within(common, cycles)
    difference = measured.counts[i[chosen]] - simulated.counts[j[chosen]]
    difference = difference[:, measured.used] / measured.full_scale
    return float((difference**2).sum()), int(chosen.sum()), difference.size


def gap_of(command, simulation, runs, cycles, work, environment):
    total, scans, readings = 0.0, 0, 0
    expected = expected_copy(simulation, work / "rig")
    for number, run in enumerate(runs):
        folder = work / ("driven_%s_%d" % (simulation.stem, number))
        for measured, simulated in zip(run, drive(command, expected, run, folder, environment)):
            sums = squares(measured, simulated, cycles.get(measured.path.name, []))
            total, scans, readings = total + sums[0], scans + sums[1], readings + sums[2]
        shutil.rmtree(folder, ignore_errors=True)
    if not readings:
        raise NotRecomputable("no scan of the bags lies in the hold-out cycles of verdict.yaml")
    return (total / readings)**0.5, scans


def bag_error():
    from rosbag import ROSBagException
    return ROSBagException


def recompute(command, bags, verdict, found, work, environment=None):
    """{before, after, scans} [share of full scale], or {problem}. `bags` are paths, `found` the folder of the verdict."""
    try:
        cycles = {bag["file"]: bag["cycles"] for bag in verdict.get("hold_out") or []}
        if not any(cycles.values()):
            raise NotRecomputable("verdict.yaml names no hold-out cycle")
        files = {"before": found / "base.yaml", "after": found / "simulation.yaml"}
        for file in files.values():
            if not file.exists():
                raise NotRecomputable("%s is missing beside verdict.yaml" % file.name)
        runs, result = runs_in_time_order([Scans(bag) for bag in bags]), {}
        for when, file in files.items():
            result[when], result["scans"] = gap_of(command, file, runs, cycles, work, environment)
        return result
    except NotRecomputable as why:
        return {"problem": str(why)}
    except (bag_error(), OSError, KeyError, TypeError, ValueError, struct.error) as error:
        return {"problem": "%s: %s" % (type(error).__name__, error)}


def write_json(path, data):
    fresh = path.with_suffix(".new")
    fresh.write_text(json.dumps(data, indent=1) + "\n")
    fresh.replace(path)
