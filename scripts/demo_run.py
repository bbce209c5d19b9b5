#!/usr/bin/python3
"""Records, trains and compares on an emulated rig; started by scripts/demo. demo_options.py tells what it does."""
import contextlib
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import time

import demo_day
import demo_discrepancy
import demo_floor
import demo_history
import demo_options
import demo_score
import demo_shape
from demo_tools import START_LIMIT, Failure, process, run_tool, serves, wait_until

NAMESPACE = "fsr"
SIMULATION = pathlib.Path(__file__).resolve().parent.parent / "config/simulation/demo.yaml"
TRAINED = ["flat", "cylinder_13cm", "cylinder_11cm", "cylinder_9cm", "cylinder_7cm", "cylinder_5cm"]
UNSEEN = "cylinder_8cm"
# Scheme and history of each calibration, and the topic of its maps.
CALIBRATIONS = {
    "flat_only": ("flat_only", "none", "flat_only/pressure_map"),
    "baseline": ("baseline", "none", "baseline/pressure_map"),
    "per_curvature": ("per_curvature", "none", "per_curvature/pressure_map"),
    "interpolated": ("interpolated", "none", "pressure_map"),
    "history": ("interpolated", "auto", "history/pressure_map"),
}
MAPS = {name: topic for name, (_, _, topic) in CALIBRATIONS.items()}
# What the chamber does in training: two paces, short and long dwells, full and partial cycles; and in the live runs: a pace and
# dwells that took no part in training. Gauge pressure [Pa], rate [Pa/s], dwells [s].
TRAINING = [
    {"peak": 620e3, "rate": 17e3, "dwell_peak": 1.0, "dwell_rest": 1.0},
    {"peak": 620e3, "rate": 60e3, "dwell_peak": 15.0, "dwell_rest": 15.0},
    {"peak": 350e3, "rate": 60e3, "dwell_peak": 2.0, "dwell_rest": 5.0},
]
LIVE = [{"peak": 620e3, "rate": 30e3, "dwell_peak": 8.0, "dwell_rest": 8.0}]
SHOW_PRESSURE = 300e3  # the picture is taken above this gauge pressure [Pa]


def say(text):
    print(f"[{time.monotonic() - STARTED:5.1f} s] {text}", flush=True)


STARTED = time.monotonic()


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Rig:
    """The emulated rig, controlled by the services that a user would call."""

    def __init__(self, logs):
        import rosgraph
        import rospy
        from fsr_pressure_map.srv import SetSurface
        from std_msgs.msg import String
        from std_srvs.srv import Trigger
        self.logs = logs
        self.master = rosgraph.Master("/demo")
        self.rospy = rospy
        self.status = ""
        rospy.init_node("demo", disable_signals=True)
        rospy.Subscriber(f"/{NAMESPACE}/rig_emulator/status", String, self.on_status)
        self.call_surface = self.service("rig_emulator/set_surface", SetSurface)
        self.call_curvature = self.service("curvature/set_surface", SetSurface)
        self.call_start = self.service("rig_emulator/start", Trigger)

    def service(self, name, kind):
        full_name = f"/{NAMESPACE}/{name}"
        self.rospy.wait_for_service(full_name, START_LIMIT)
        return self.rospy.ServiceProxy(full_name, kind)

    def on_status(self, message):
        self.status = message.data

    def mount(self, surface, mount):
        for call in (self.call_surface, self.call_curvature):
            reply = call(surface, mount)
            if not reply.success:
                raise Failure(reply.message)

    def subscribed(self, node, topic):
        """Whether `node` is registered at the master as a subscriber of `topic`."""
        subscribers = dict(self.master.getSystemState()[1])
        return f"/{NAMESPACE}/{node}" in subscribers.get(f"/{NAMESPACE}/{topic}", [])

    def run_cycles(self, protocol, cycles, limit):
        rates = {"fill_rate": protocol["rate"], "vent_rate": protocol["rate"]}
        self.rospy.set_param(f"/{NAMESPACE}/rig_emulator/chamber", {**protocol, **rates, "cycles": cycles})
        self.status = ""
        reply = self.call_start()
        if not reply.success:
            raise Failure(reply.message)
        give_up = time.monotonic() + limit
        while not self.status.startswith("done"):
            if time.monotonic() > give_up:
                raise Failure(f"the chamber cycles did not end within {limit:.0f} s; the logs are in {self.logs}")
            time.sleep(0.02)

    @contextlib.contextmanager
    def recording(self, bag, surface, trial, topics=()):
        """record.launch, from the time on at which it receives scans. Its bag is complete when the block is left."""
        log = self.logs / f"record_{bag.name}.log"
        command = ["roslaunch", "fsr_pressure_map", "record.launch", f"bag:={bag}", f"trial:={trial}",
                   "protocol:=demo_cycles", f"session:=demo_{surface}", "use:=chamber", "mounted_on:=fixture"]
        if topics:
            command.append("extra_topics:=" + " ".join(f"/{NAMESPACE}/{topic}" for topic in topics))
        with process(command, log) as child:
            wait_until(lambda: self.subscribed("record", "raw") and self.subscribed("record", "chamber_pressure"),
                       child, "the recorder", log)
            yield child
        if not bag.with_suffix(".bag").exists():
            raise Failure(f"the recorder left no {bag.with_suffix('.bag')}; its log is {log}")

    def record(self, bag, surface, trial, protocols, cycles, limit, topics=()):
        """Records `cycles` chamber cycles of each protocol with record.launch and returns the path of the bag."""
        with self.recording(bag, surface, trial, topics):
            for protocol in protocols:
                self.run_cycles(protocol, cycles, limit)
        return bag.with_suffix(".bag")


def train(name, bags, output, logs):
    scheme, history, _ = CALIBRATIONS[name]
    return run_tool(logs / f"train_{name}.log", "train", *bags, "--scheme", scheme, "--history", history, "--output", output)


def show(rig, output, logs, limit):
    """Opens rviz on the live map while the chamber is under pressure. Returns the path of the screenshot, or None."""
    config = pathlib.Path(subprocess.check_output(["rospack", "find", "fsr_pressure_map"], text=True).strip())
    rviz = ["rviz", "-d", str(config / "config/rviz/live.rviz"), "--splash-screen", ""]
    picture = output / "rviz.png"
    with contextlib.ExitStack() as stack:
        environment = dict(os.environ)
        if not environment.get("DISPLAY"):
            environment["DISPLAY"] = f":{70 + os.getpid() % 900}"
            server = ["Xvfb", environment["DISPLAY"], "-screen", "0", "1280x800x24", "-nolisten", "tcp"]
            child = stack.enter_context(process(server, logs / "xvfb.log", signal.SIGTERM))
            wait_until(lambda: subprocess.run(["xdpyinfo"], env=environment, stdout=subprocess.DEVNULL,
                                              stderr=subprocess.DEVNULL).returncode == 0,
                       child, "the headless X server", logs / "xvfb.log")
        log = logs / "rviz.log"
        child = stack.enter_context(process(rviz, log, env=environment))
        wait_until(lambda: any("rviz" in node for node in
                               dict(rig.master.getSystemState()[1]).get(f"/{NAMESPACE}/pressure_map", [])), child, "rviz", log)
        taken = demo_score.screenshot(rig, picture, environment, SHOW_PRESSURE, limit)
        if os.environ.get("DISPLAY") and sys.stdout.isatty():
            say("rviz shows the live map; close its window to end the demo")
            child.wait()
        return picture if taken else None


def record_training(rig, arguments, output, limit):
    say(f"the rig runs at {arguments.time_scale:g} x real time; recording {len(TRAINED)} surfaces, {len(TRAINING)} protocols on each")
    bags = []
    for mount, surface in enumerate(TRAINED, start=1):
        rig.mount(surface, mount)
        bags.append(rig.record(output / f"{mount}_{surface}", surface, mount, TRAINING, arguments.cycles, limit))
        say(f"recorded {bags[-1]}")
    return bags


def train_all(bags, output, logs):
    calibrations = {}
    for name in CALIBRATIONS:
        calibrations[name] = output / f"{name}.h5"
        report = train(name, bags, calibrations[name], logs)
        say(f"trained {calibrations[name]}")
    print(report)
    return calibrations


def run_live(rig, arguments, calibrations, output, logs, limit):
    """The bags of the live runs by surface, and the picture of rviz."""
    files = [f"{name}:={file}" for name, file in calibrations.items()]
    log = logs / "compare.log"
    with process(["roslaunch", "fsr_pressure_map", "compare.launch", "driver:=false", *files], log) as child:
        nodes = ["calibration" if name == "interpolated" else f"calibration_{name}" for name in calibrations]
        wait_until(lambda: all(rig.subscribed(node, "raw") for node in nodes), child, "compare.launch", log)
        say("five calibration nodes run; cycles of another pace and dwell on every surface, and on one that was not used for training")
        live = {}
        for mount, surface in enumerate(TRAINED + [UNSEEN], start=len(TRAINED) + 1):
            rig.mount(surface, mount)
            live[surface] = rig.record(output / f"live_{surface}", surface, mount, LIVE, arguments.live_cycles, limit, MAPS.values())
            say(f"live run recorded in {live[surface]}")
        return live, None if arguments.no_rviz else show(rig, output, logs, limit)


def run(rig, arguments, output, logs, limit):
    say("the sheet is mounted twice on each surface, and recorded at rest before its first load")
    mounts = demo_shape.record_mounts(rig, TRAINED, output / "0_mounts")
    bags = record_training(rig, arguments, output, limit)
    calibrations = train_all(bags, output, logs)
    live, picture = run_live(rig, arguments, calibrations, output, logs, limit)
    return mounts, bags, calibrations, picture, live


def run_mistake(rig, arguments, board, mounts, bags, output, logs, limit):
    """On an emulator that starts anew, with a sheet that was not loaded yet: answers of the sheet that lies on another surface than
    its file says, and the rows of the table of errors."""
    calibration, folder, log = output / "shape.h5", output / "shape", logs / "rig_shape.log"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    # No scores: mounts without a load do not tell the error of another mount.
    run_tool(logs / "train_shape.log", "train", mounts, *bags, "--no-scores", "--output", calibration)
    say(f"trained {calibration}, with the mounts at rest; the sheet is mounted on {demo_shape.TRUE}, but the launch file says {demo_shape.WRONG}")
    rig_launch = ["roslaunch", "fsr_pressure_map", "rig_emulator.launch", f"link:={board}", f"time_scale:={arguments.time_scale}",
                  f"seed:={arguments.seed}", f"simulation:={SIMULATION}", "autostart:=false", f"surface:={demo_shape.TRUE}",
                  f"mount:={demo_shape.MOUNT}"]
    with process(rig_launch, log) as child:
        wait_until(lambda: serves(f"/{NAMESPACE}/rig_emulator/start"), child, "the rig", log)
        answers = demo_shape.mistake(rig, board, calibration, folder, logs, LIVE, arguments.live_cycles, limit)
    say(f"the sheet was asked, and a loading recorded in {folder / 'load.bag'}")
    return answers, *demo_shape.errors(folder, calibration, logs)


def score_live(arguments, bags, live, output, logs):
    """The scores of every live run, and the picture of errors against time since the last reversal."""
    say("the floor: the same rig without loop and creep, driven by the pressure of these bags")
    floor = demo_floor.floor_maps(SIMULATION, arguments.seed, bags, list(live.values()), output / "floor", logs)
    runs = {}
    for surface, path in live.items():
        run_of = demo_score.read_run(path, NAMESPACE, MAPS)
        run_of.series["floor"] = floor[path.name]
        runs[surface] = run_of
    scores = {surface: demo_score.score(run_of) for surface, run_of in runs.items()}
    drawing = demo_history.draw([runs[surface] for surface in TRAINED], output / "history")
    return scores, drawing


def prepare(arguments):
    """The folders of results and logs, emptied, and the port of a master of its own."""
    output = pathlib.Path(arguments.output).resolve()
    shutil.rmtree(output / "logs", ignore_errors=True)
    logs = output / "logs"
    logs.mkdir(parents=True)
    for old in output.glob("*.bag*"):
        old.unlink()
    os.environ.update(ROS_MASTER_URI=f"http://127.0.0.1:{free_port()}", ROS_IP="127.0.0.1",
                      ROS_HOME=str(output / "ros_home"), ROS_LOG_DIR=str(logs / "ros"))
    return output, logs, os.environ["ROS_MASTER_URI"].rsplit(":", 1)[1]


def run_day(arguments, output, logs, port):
    """The conducted day instead of the demo. Returns the exit status."""
    try:
        with process(["roscore", "-p", port], logs / "roscore.log") as core:
            import rosgraph
            wait_until(rosgraph.is_master_online, core, "roscore", logs / "roscore.log")
            demo_day.run(arguments, output, logs, say)
    except Failure as failure:
        print(f"demo: {failure}", file=sys.stderr)
        return 1
    say("the day is done: the plan came to its end")
    return 0


def main():
    arguments = demo_options.read()
    output, logs, port = prepare(arguments)
    if arguments.day:
        return run_day(arguments, output, logs, port)
    log = logs / "rig.log"
    board = output / "board"
    limit = 60 + 200 * max(arguments.cycles, arguments.live_cycles) / arguments.time_scale
    rig_launch = ["roslaunch", "fsr_pressure_map", "demo.launch", f"link:={board}",
                  f"time_scale:={arguments.time_scale}", f"seed:={arguments.seed}", f"simulation:={SIMULATION}", "autostart:=false"]
    say(f"starting roscore on 127.0.0.1:{port}, the emulated rig and the driver; all files go to {output}")
    try:
        with process(["roscore", "-p", port], logs / "roscore.log") as core:
            import rosgraph
            wait_until(rosgraph.is_master_online, core, "roscore", logs / "roscore.log")
            with process(rig_launch, log) as child:
                wait_until(lambda: serves(f"/{NAMESPACE}/rig_emulator/start"), child, "the rig", log)
                rig = Rig(logs)
                mounts, bags, calibrations, picture, live = run(rig, arguments, output, logs, limit)
            answers, rows, live_error = run_mistake(rig, arguments, board, mounts, bags, output, logs, limit)
        scores, drawing = score_live(arguments, bags, live, output, logs)
    except Failure as failure:
        print(f"demo: {failure}", file=sys.stderr)
        return 1
    print(demo_score.table(scores, TRAINED, UNSEEN))
    print(demo_shape.sentences(answers))
    print(demo_shape.table(rows, live_error, output) + "\n")
    print("bags         " + "\n             ".join(map(str, [mounts, *bags])))
    print("calibrations " + "\n             ".join(map(str, [*calibrations.values(), output / "shape.h5"])))
    print(f"screenshot   {picture or 'none'}")
    print(f"errors       {drawing}")
    try:
        print(demo_discrepancy.find_hidden(output / "discrepancy", say))
    except (OSError, subprocess.CalledProcessError) as error:
        print(f"demo: discrepancy: {error}", file=sys.stderr)
        return 1
    complaints = demo_score.complaints(scores, TRAINED) + demo_shape.complaints(answers, rows)
    if not arguments.no_rviz and picture is None:
        complaints.append("no picture of the map could be taken")
    for complaint in complaints:
        print(f"demo: {complaint}", file=sys.stderr)
    say("the demo FAILED" if complaints else
        "the demo is done: calibrations that know the curvature have the smaller error on every bent surface, history has no "
        "larger one than the static answer, and the sheet at rest found the wrong surface file")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
