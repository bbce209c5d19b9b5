#!/usr/bin/python3
"""The demo's sheet that does not lie as its surface file says.

    scripts/demo_shape.py DIR    # prints the table of errors again, from the bags and the calibration in DIR (the demo's --output)

The rig emulator has the sheet on a cylinder of 5 cm, and calibrated.launch is told 9 cm. The services of the calibration node are asked
what the unloaded sheet says. Then the map of one run is computed with the wrong, the estimated and the true surface.
"""
import argparse
import collections
import contextlib
import importlib.util
import pathlib
import sys
import time

sys.dont_write_bytecode = True
import demo_floor  # noqa: E402
import demo_score  # noqa: E402
from demo_tools import START_LIMIT, Failure, process, run_tool, serves, wait_until  # noqa: E402

WRONG, TRUE = "cylinder_9cm", "cylinder_5cm"
MOUNT = 101  # of the sheet on TRUE; took no part in training
REMOUNTED = range(21, 33)  # numbers of the mounts that are recorded at rest only, two of each surface
REST = 5.0  # of each [s]; 2 s are used
HAS_SCANS = 10000  # size of a bag that has begun to receive scans [bytes]
SETUP = "out/devel/setup.bash"
USES = {"wrong": f"wrong: {WRONG}", "estimated": "estimated", "true": f"true: {TRUE}"}
FOUND = "but the surface file says"  # in the answer of check_surface to a surface that disagrees

Answer = collections.namedtuple("Answer", ("given", "sentence"))  # of a service
Row = collections.namedtuple("Row", ("curvature", "deviation", "score"))  # [1/m], NaN = not stated


def record_mounts(rig, surfaces, bag):
    """Records the unloaded sheet on each surface, mounted anew each time, before its first load. Returns the path of the bag."""
    from sensor_msgs.msg import FluidPressure
    newest, active = {"stamp": 0.0}, bag.with_suffix(".bag.active")
    subscriber = rig.rospy.Subscriber("/fsr/chamber_pressure", FluidPressure,
                                      lambda message: newest.update(stamp=message.header.stamp.to_sec()))
    with rig.recording(bag, "mounts", 0) as child:
        wait_until(lambda: newest["stamp"] > 0 and active.exists() and active.stat().st_size > HAS_SCANS, child, "the recorder", rig.logs)
        for i, mount in enumerate(REMOUNTED):
            rig.mount(surfaces[i % len(surfaces)], mount)
            end = newest["stamp"] + REST
            wait_until(lambda: newest["stamp"] >= end, child, "a rest", rig.logs)
    subscriber.unregister()
    return bag.with_suffix(".bag")


@contextlib.contextmanager
def calibrated(rig, board, calibration, log, *arguments):
    """calibrated.launch on the board, as a user starts it, from the first map on that is made with the calibration."""
    from fsr_pressure_map.msg import PressureMap
    command = ["roslaunch", "fsr_pressure_map", "calibrated.launch", f"serial_port:={board}", "serial_baud:=0", f"calibration:={calibration}",
               *arguments]
    with process(command, log) as child:
        wait_until(lambda: serves("/fsr/calibration/estimate_surface"), child, "calibrated.launch", log)
        latest(rig, "pressure_map", PressureMap, lambda message: message.state != PressureMap.STATE_UNCALIBRATED)
        yield child


def latest(rig, topic, kind, right=lambda message: True):
    """A message of the topic for which `right` holds."""
    give_up = time.monotonic() + START_LIMIT
    try:
        while time.monotonic() < give_up:
            message = rig.rospy.wait_for_message(f"/fsr/{topic}", kind, START_LIMIT)
            if right(message):
                return message
    except rig.rospy.ROSException:
        pass
    raise Failure(f"nothing that is expected came on {topic} within {START_LIMIT:.0f} s; the logs are in {rig.logs}")


def ask(rig, service):
    from std_srvs.srv import Trigger
    reply = rig.service(f"calibration/{service}", Trigger)()
    return Answer(reply.success, reply.message)


def mistake(rig, board, calibration, folder, logs, protocols, cycles, limit):
    """Asks the sheet, which lies on TRUE, with the wrong file and the true one, uses its estimate, and records a loading. Leaves a
    bag for each use in the folder. Returns the answers: check, check_true, estimate."""
    from fsr_pressure_map.msg import PressureMap, SurfaceCurvature
    answers, surfaces = {}, {}

    def published(name):
        return latest(rig, "curvature", SurfaceCurvature, lambda message: message.surface == name)

    def declared(name):
        """The surface, once maps are made with one: the calibration node receives it by another way than this script."""
        surface = published(name)
        latest(rig, "pressure_map", PressureMap,
               lambda message: message.state != PressureMap.STATE_CURVATURE_UNKNOWN and message.header.stamp > surface.header.stamp)
        return surface

    with calibrated(rig, board, calibration, logs / "shape_wrong.log", f"surface:={WRONG}", f"mount:={MOUNT}"):
        surfaces["wrong"] = declared(WRONG)
        answers["check"] = ask(rig, "check_surface")
        rig.call_curvature(TRUE, MOUNT)
        surfaces["true"] = declared(TRUE)
        answers["check_true"] = ask(rig, "check_surface")
    with calibrated(rig, board, calibration, logs / "shape_estimated.log", "curvature:=estimated"):
        answers["estimate"] = ask(rig, "estimate_surface")
        if answers["estimate"].given:
            surfaces["estimated"] = published("estimated")
        load = rig.record(folder / "load", "shape", MOUNT, protocols, cycles, limit, ["pressure_map"])
    for use, surface in surfaces.items():
        exchange(load, surface, folder / f"{use}.bag")
    return answers


def exchange(bag, surface, target):
    """Copies the readings of a bag. `surface` takes the place of its curvature."""
    import rosbag
    with rosbag.Bag(str(bag)) as source, rosbag.Bag(str(target), "w") as copy:
        _, first, start = next(source.read_messages(topics=["/fsr/raw"]))
        surface.header.stamp = first.header.stamp
        copy.write("/fsr/curvature", surface, start)
        for topic, message, received in source.read_messages():
            if topic not in ("/fsr/curvature", "/fsr/pressure_map"):
                copy.write(topic, message, received)


def curvature_of(bag):
    """Curvature and its standard deviation in the first message [1/m]."""
    import rosbag
    with rosbag.Bag(str(bag)) as opened:
        _, surface, _ = next(opened.read_messages(topics=["/fsr/curvature"]))
    return surface.x[0], surface.deviation[0] if surface.deviation else float("nan")


def errors(folder, calibration, logs):
    """For each use whose bag is in the folder: its row of the table. All have the same readings. Beside them the error of the live map
    of the run, in which the node used its estimate [kPa]."""
    bags = [folder / f"{use}.bag" for use in USES if (folder / f"{use}.bag").exists()]
    table = folder / "maps.csv"
    run_tool(logs / "shape_export.log", "export", *bags, "--calibration", calibration, "--to", "csv", "--output", table)
    maps = demo_floor.read_maps(table)
    table.unlink()
    run = demo_score.read_run(folder / "load.bag", "fsr", {"history": "pressure_map"})
    run.series.update({bag.stem: maps[bag.name] for bag in bags})
    scores = demo_score.score(run)
    return {bag.stem: Row(*curvature_of(bag), scores[bag.stem]) for bag in bags}, scores["history"]["rmse_kpa"]


def table(rows, live, folder):
    """`rows`, `live`: of errors(); `folder`: of the demo."""
    true, scans = (rows["true"].score[name] for name in ("rmse_kpa", "scans"))
    lines = ["", f"Error of the map on a new mount of {TRUE} whose surface file said {WRONG}: mean over taxels of the RMSE over cycles of a pace",
             f"and dwell that took no part in training. The readings are the same in all rows ({scans} scans); the map is computed anew for each",
             "with the curvature that its row says. The sheet was never loaded before.", "",
             f"{'surface that is used':26s}{'curvature [1/m]':>18s}{'% of range':>12s}{'kPa':>8s}{'bias kPa':>10s}{'x true':>8s}"]
    for use, name in USES.items():
        if use not in rows:
            lines.append(f"{name:26s}{'none':>18s}")
            continue
        curvature, deviation, score = rows[use]
        told = f"{curvature:.2f}" + ("" if deviation != deviation else f" +- {deviation:.2f}")
        lines.append(f"{name:26s}{told:>18s}{score['rmse_percent']:12.2f}{score['rmse_kpa']:8.1f}{score['bias_kpa']:10.1f}"
                     f"{score['rmse_kpa'] / true:8.2f}")
    if "estimated" in rows:
        lines += ["", f"The node that used its estimate published maps of this run with an error of {live:.1f} kPa."]
    return "\n".join([*lines, "", f"recompute    . {SETUP}; scripts/demo_shape.py {folder}"])


def sentences(answers):
    """What the sheet said, with the services that were asked."""
    said = [("check_surface", WRONG, "check"), ("check_surface", TRUE, "check_true"), ("estimate_surface", "curvature:=estimated", "estimate")]
    return "\n".join(f"~{service}, {told}: {answers[name].sentence}" for service, told, name in said)


def complaints(answers, rows):
    """Sentences that contradict "the sheet at rest finds a wrong surface file, and its estimate helps"; empty = none."""
    result, check = [], answers["check"]
    if not (check.given and FOUND in check.sentence):
        result.append(f"the wrong surface file was not found: {check.sentence}")
    if "estimated" in rows and not rows["estimated"].score["rmse_kpa"] < rows["wrong"].score["rmse_kpa"]:
        result.append("the map does not have a smaller error with the estimated surface than with the wrong one")
    return result


def main():
    parser = argparse.ArgumentParser(prog="demo_shape.py", description=__doc__, allow_abbrev=False, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path, help="folder that scripts/demo wrote")
    output = parser.parse_args().folder.resolve()
    if not (output / "shape" / "load.bag").exists():
        print(f"demo_shape.py: {output}: there is no shape/load.bag; give the folder that scripts/demo wrote", file=sys.stderr)
        return 1
    if importlib.util.find_spec("fsr_pressure_map") is None:
        print(f"demo_shape.py: the package is not known to this shell; call `. {SETUP}` before", file=sys.stderr)
        return 1
    try:
        print(table(*errors(output / "shape", output / "shape.h5", output / "logs"), output))
    except Failure as failure:
        print(f"demo_shape.py: {failure}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
