#!/usr/bin/python3
"""Every command in the code blocks of README.md and docs/*.md, as it stands there, with files of the names that it uses.

Each runs in a folder of its own that looks like the checkout. A program that has computed for BUSY seconds is ended and passes: its
arguments and files were accepted by then. A launch command is checked as the launch file itself checks it; what the launch files then do is tested by
the other rostests. NOT_RUN lists what cannot run here.
"""
import collections
import concurrent.futures
import contextlib
import math
import os
import pathlib
import re
import resource
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import unittest

import rospy
import rostest
from terminal import PROGRAMS

SOURCE = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(SOURCE / "test/scripts"))
from bare_shell import module  # noqa: E402

PAGES = [SOURCE / "README.md", *sorted((SOURCE / "docs").glob("*.md"))]
BUSY = 2        # CPU time of one program [s]
ENDED_BUSY = {-signal.SIGXCPU, 128 + signal.SIGXCPU}  # exit status of a program that is ended so, and of a shell whose program is
FIGURES_BUSY = "exit status %d" % signal.SIGXCPU  # what a tool says of a script of figures that is ended so
LISTENS = 4     # for what never ends [s]
PATIENCE = 60   # for nodes and what does not compute [s]
REFUSED = 2     # exit status of wrong usage, of tools and of ROS's programs

STARTS = re.compile(r"(ros\w+|scripts/\S+|[.]ci/\S+|(?:out|test|/usr)/\S+|sudo|mkdir|tar|gcc|sha256sum|export|[.](?= \w)|columns=\S+) ?(?![=:(])")
IN_TEXT = re.compile(r"`((?:rosservice call|rosparam|roslaunch|scripts/\w+) [^`]*)`")
BARE_TOOL = re.compile(r"(train|check_bag|check_calibration|discrepancy|simulate|study|export|scrub|csv_to_bag|plan_session|day_report) .*(--|[.]bag)")

# Beginning of a command -> why it is not run here. The options of the package's own scripts are looked up in their --help.
NOT_RUN = {
    ". out/devel/setup.bash": "the environment of this test",
    "sudo ": "changes the system; test/packaging/bare_system installs the packages",
    "export ROS_": "the addresses of two computers; ros.two_machines",
    "scripts/install_packages": "changes the system",
    "scripts/align": "needs a table of another system; scripts.align",
    "scripts/draw_map": "needs a file of export --to hdf5; scripts.draw_map",
    "scripts/import_maps": "needs a file of another system; scripts.import_maps",
    "scripts/compare_history": "computes for minutes",
    "scripts/package": "builds the packages; test/packaging/bare_system",
    "scripts/demo": "builds and measures for minutes",
    "scripts/test": "runs the tests",
    "out/devel/lib/fsr_pressure_map/": "a program of tests",
    "/usr/bin/python3 test/data/make_regression_data.py": "writes the data of the tests anew",
    "scripts/build": "builds",
    "scripts/benchmark": "measures for minutes, and installs packages",
    "scripts/soak": "takes minutes",
    "scripts/sanitize": "builds with sanitizers",
    "scripts/measure_": "measures for minutes",
    "test/benchmark/cpu_share.py": "measures for minutes",
    "roslaunch test/benchmark/map_latency.launch": "measures for minutes; needs the benchmarks",
    "scripts/blind_trials": "computes for hours",
    "scripts/follow_trials": "computes for hours",
    "scripts/prove_effects": "computes for hours",
    "scripts/score_cases": "scores what blind trials made in hours; test/blind",
    "scripts/run_shards": "computes for hours; scripts.run_shards",
    "rosrun fsr_pressure_map day_report": "needs a conducted session; ros.day",
    "rosrun image_view": "needs a screen",
    "gcc -std=c99 check.c": "needs the program on that page; test/protocol/wire_format_document_test.cpp compiles it",
}
SUBSCRIBER = "/usr/bin/python3 docs/examples/"
ENDLESS = re.compile(r"rosbag play |" + SUBSCRIBER)

RIG = """simulation: commands
seed: 3
matrix: {rows: 3, columns: 4, pitch_x: 0.010, pitch_y: 0.010}
board: {scan_rate: 10, transducer_rate: 10}
chamber: {peak: 300000, rate: 60000, dwell_peak: 1, dwell_rest: 2, cycles: 4}
session: [%s]
effects:
  static_curve: {conductance: 3.0e-4, exponent: 0.9, conductance_scatter: 0.05}
  bending_preload: {amplitude: 34000, curvature_constant: 3.0}
  hysteresis: {loop_width: 0.08, span: 300000, reach: 80000}
  white_noise: {absolute: 2}
  converter: {full_scale: 4095, feedback_resistance: 3600}
"""
FLAT, CYLINDER = "{surface: flat, flat: true, pause: 20}", "{surface: cylinder_7cm, cylinder: {radius: 0.07, axis: y}, pause: 20}"
NODES = """<launch>
  <include file="$(find fsr_pressure_map)/launch/rig_emulator.launch">
    <arg name="link" value="{folder}/board"/>
    <arg name="simulation" value="{folder}/rig.yaml"/>
    <arg name="autostart" value="false"/>
  </include>
  <include file="$(find fsr_pressure_map)/launch/calibrated.launch">
    <arg name="serial_port" value="{folder}/board"/>
    <arg name="serial_baud" value="0"/>
    <arg name="calibration" value="{folder}/calibration.h5"/>
    <arg name="surface" value="flat"/>
  </include>
  <include file="$(find fsr_pressure_map)/launch/session.launch">
    <arg name="plan" value="{folder}/day.yaml"/>
    <arg name="folder" value="{folder}/conducted"/>
    <arg name="surfaces" value="$(find fsr_pressure_map)/config/surfaces"/>
    <arg name="report" value="false"/>
  </include>
  <include file="$(find fsr_pressure_map)/launch/train.launch">
    <arg name="output" value="{folder}/trained.h5"/>
  </include>
</launch>
"""
# What services say that refuse rightly here.
REFUSALS = {
    "/fsr/calibration/check_surface": "three are needed to learn how the sheet rests",
    "/fsr/calibration/estimate_surface": "three are needed to learn how the sheet rests",
    "/fsr/training/train": "training needs cycles",
}


def code_blocks(text):
    """Text of each fenced block that names no language, and of each block that is indented by four blanks or more."""
    block, fence = [], None
    for line in [*text.splitlines(), ""]:
        mark = re.match(r" *```(.*)", line)
        if mark:
            fence = None if fence is not None else mark.group(1)
        if not mark and (fence == "" or (fence is None and line.startswith("    "))):
            block.append(line)
        elif block:
            yield "\n".join(block)
            block = []


def commands_of(page):
    """The commands of a page: lines, with those that they continue on; a block with a loop is one."""
    for block in code_blocks(page.read_text()):
        lines = [line.strip() for line in re.sub(r"\\\n *", "", block).splitlines()]
        if any(line.startswith("for ") and line.endswith("; do") for line in lines):
            yield "\n".join(lines)
        else:
            yield from (line for line in lines if STARTS.match(line) or BARE_TOOL.match(line))
    yield from (" ".join(span.split()) for span in IN_TEXT.findall(page.read_text()))


def all_commands():
    return sorted({re.sub(r" +#.*", "", command) for page in PAGES for command in commands_of(page)})


def reason_not_to_run(command):
    return next((start for start in NOT_RUN if command.startswith(start)), None)


def write_socket(path):
    """The wall of a cylinder of 5 cm around z, 24 cm high, as ASCII STL in mm."""
    corner = [(50 * math.cos(0.1 * i), 50 * math.sin(0.1 * i)) for i in range(-31, 32)]
    with open(path, "w") as out:
        print("solid socket", file=out)
        for (a, b), (c, d) in zip(corner, corner[1:]):
            for z in range(0, 240, 10):
                for triangle in (((a, b, z), (c, d, z), (c, d, z + 10)), ((a, b, z), (c, d, z + 10), (a, b, z + 10))):
                    print("facet normal 0 0 0\nouter loop", *("vertex %g %g %g" % point for point in triangle), "endloop\nendfacet",
                          sep="\n", file=out)
        print("endsolid socket", file=out)


class Stock:
    """One file of each kind that the commands read."""

    def __init__(self, folder):
        self.folder = folder
        (folder / "rig.yaml").write_text(RIG % ", ".join(4 * [FLAT, CYLINDER]))
        self.run("simulate", "--simulation", "rig.yaml", "--output", "simulated")
        self.bags = sorted((folder / "simulated").glob("*.bag"))
        quick = "--no-scores", "--zero", "none", "--history", "none"
        self.run("train", *self.bags, *quick, "--output", "calibration.h5")
        for i, name in enumerate(("first.h5", "second.h5")):
            self.run("train", *self.bags[2 * i:2 * i + 2], *quick, "--output", name)
        self.run("plan_session", "--for", "per_curvature", "--minutes", "45", "--output", "day.yaml")
        self.put_all("session/*.bag", folder)
        self.run("discrepancy", "session/", "--no-report", "--output", "found")
        write_socket(folder / "socket.stl")
        (folder / "regions.yaml").write_text("regions: [{name: heel, rows: [0, 0]}]\n")
        (folder / "left_wall.yaml").write_text((SOURCE / "config/surfaces/socket_wall_7cm.yaml").read_text())
        (folder / "table.csv").write_text("time,force_V,p\n" + "".join("%d,%g,%g\n" % (100 * i, 0.1 * i, 0.2 * i) for i in range(20)))

    def run(self, tool, *words):
        done = subprocess.run([str(PROGRAMS / tool), *map(str, words)], cwd=self.folder, text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT)
        if done.returncode != 0:
            raise AssertionError("%s %s: %s" % (tool, words, done.stdout))

    def bag(self, name, number):
        """Every second bag is of a cylinder."""
        return self.bags[(2 * number + self.is_curved(name)) % len(self.bags)]

    @staticmethod
    def is_curved(name):
        return bool(re.search("cylinder|wall", name))

    def put_all(self, pattern, folder):
        for i, name in enumerate(("1_flat", "2_cylinder_7cm", "3_flat")):
            self.put(folder / pattern.replace("*", name), self.bag(name, i))

    def furnish(self, folder, command):
        """Puts what the command reads into the folder."""
        for name in ("config", "docs", "scripts", "test", "launch"):
            (folder / name).symlink_to(SOURCE / name)
        read = re.sub(r"--output \S+", "", command)
        for pattern in re.findall(r"\S*[*][.]bag", read) + [word + "/*.bag" for word in re.findall(r" (session|DIR)(?:/? |$)", read)]:
            self.put_all(pattern, folder)
        used = collections.Counter()
        for name in dict.fromkeys(re.findall(r"[\w./]+[.]bag(?:[.]active)?\b", read)):
            kind = self.is_curved(name)
            self.put(folder / name, self.bag(name, 3 + used[kind]))  # another than those of a folder
            used[kind] += 1
        for name in re.findall(r"[\w./]+[.]h5\b", read):
            part = {"A.h5": "first.h5", "monday.h5": "first.h5", "B.h5": "second.h5", "tuesday.h5": "second.h5"}
            self.put(folder / name, self.folder / part.get(name, "calibration.h5"))
        for name in re.findall(r"socket[.]stl|left_wall[.]yaml|regions[.]yaml|table[.]csv|day[.]yaml", read):
            self.put(folder / name, self.folder / name)
        if "found/" in read:
            shutil.copytree(self.folder / "found", folder / "found", copy_function=os.link)

    def put(self, path, content):
        path.parent.mkdir(parents=True, exist_ok=True)
        if not path.exists():
            os.link(content, path)


def filled(command):
    """The command with a file for each placeholder, and with what stands in brackets."""
    for placeholder, name in (("--output BAG", "--output made.bag"), ("BAG...", "1_flat.bag 2_cylinder_7cm.bag"), ("TABLE", "table.csv"),
                              ("--to FORMAT --output PATH", "--to csv --output made.csv")):
        command = command.replace(placeholder, name)
    return re.sub(r"\bBAG\b", "1_flat.bag", re.sub(r"\[(--.*?)\]", r"\1", command))


class CommandsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        (cls.folder / "stock").mkdir()
        cls.stock = Stock(cls.folder / "stock")
        cls.commands = [command for command in all_commands() if not reason_not_to_run(command)]
        cls.count, cls.lock = 0, threading.Lock()

    def sandbox(self, command):
        with self.lock:
            type(self).count += 1
            folder = self.folder / str(self.count)
        folder.mkdir()
        self.stock.furnish(folder, command)
        return folder

    def run_there(self, command, seconds, busy=None):
        """(exit status, None = still running or busy for so long; output)"""
        folder = self.sandbox(command)
        environment = dict(os.environ, ROS_HOME=str(folder / "ros_home"), HOME=str(folder), MPLBACKEND="Agg")
        child = subprocess.Popen(["bash", "-c", command], cwd=folder, env=environment, text=True, start_new_session=True,
                                 stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                 preexec_fn=busy and (lambda: resource.setrlimit(resource.RLIMIT_CPU, (busy, busy + 1))))
        try:
            said, _ = child.communicate(timeout=seconds)
            ended_busy = child.returncode in ENDED_BUSY or FIGURES_BUSY in said
            return None if ended_busy else child.returncode, said
        except subprocess.TimeoutExpired:
            os.killpg(child.pid, signal.SIGKILL)
            return None, child.communicate()[0]

    def run_all(self, commands, *limits):
        """Runs the commands, as many at a time as there are cores; {command: (status, output)}."""
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            return dict(zip(commands, pool.map(lambda command: self.run_there(filled(command), *limits), commands)))

    def of(self, pattern):
        return [command for command in self.commands if re.match(pattern, command)]

    @contextlib.contextmanager
    def each(self, command):
        """As subTest, of whose failures rostest says nothing."""
        try:
            yield
        except AssertionError as error:
            self.failures.append("%s: %s" % (command, error))

    def setUp(self):
        self.failures = []

    def tearDown(self):
        self.assertFalse(self.failures, "\n".join(self.failures))

    def test_the_commands_are_found(self):
        self.assertGreater(len(self.commands), 80)

    def test_each_exception_is_of_a_command(self):
        for start in NOT_RUN:
            self.assertTrue(any(command.startswith(start) for command in all_commands()), "no page has %r any more" % start)

    def test_scripts_have_the_options(self):
        """Of those that are not run; --help itself is what is called here."""
        options = {}
        for command in filter(reason_not_to_run, all_commands()):
            for script, words in re.findall(r"(scripts/\w+)((?: (?!--? |&&)\S+)*)", command):
                options.setdefault(script, set()).update(re.findall(r" (--[\w-]+)", words))
        self.assertGreater(len(options), 15)
        for script, names in options.items():
            with self.each(script):
                said = subprocess.run([str(SOURCE / script), "--help"], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
                self.assertEqual(said.returncode, 0, said.stdout)
                self.assertEqual({name for name in names - {"--help"} if name not in said.stdout}, set())

    def test_launch_files_take_the_arguments(self):
        check = module("launch_check")
        commands = self.of("roslaunch ")
        self.assertGreater(len(commands), 30)
        for command in commands:
            with self.each(command):
                call = check.Call(shlex.split(command)[1:])
                self.assertEqual(call.files[:1], ["fsr_pressure_map"])
                self.assertIsNotNone(call.shipped(), "there is no such launch file")
                check.check_arguments(call)
                root = check.ElementTree.parse(call.shipped()).getroot()
                needed = {arg.get("name") for arg in root.findall("arg") if not {"default", "value"} & set(arg.attrib)}
                self.assertLessEqual(needed, set(call.arguments))
                surface = call.arguments.get("surface", "")
                self.assertTrue("/" in surface or not surface or (SOURCE / "config/surfaces" / (surface + ".yaml")).exists(), surface)

    def test_tools_and_scripts(self):
        commands = [command for command in self.of("(?!roslaunch |rosservice |rostopic )") if not ENDLESS.match(command)]
        self.assertGreater(len(commands), 40)
        for command, (status, said) in self.run_all(commands, PATIENCE, BUSY).items():
            with self.each(command):
                self.assertTrue(status is None or 0 <= status < REFUSED, "status %s\n%s" % (status, said[-2000:]))

    def test_services_and_topics(self):
        folder = self.sandbox("calibration.h5 day.yaml")
        (folder / "rig.yaml").write_text(RIG % FLAT)
        (folder / "nodes.launch").write_text(NODES.format(folder=folder))
        log = open(folder / "log", "w+")
        self.addCleanup(log.close)
        nodes = subprocess.Popen(["roslaunch", str(folder / "nodes.launch")], stdout=log, stderr=subprocess.STDOUT, cwd=folder,
                                 env=dict(os.environ, PWD=str(folder), ROS_HOME=str(folder / "ros_home")))
        self.addCleanup(nodes.wait)
        self.addCleanup(nodes.send_signal, signal.SIGINT)
        services = self.of("rosservice call ")
        self.assertGreater(len(services), 8)
        for command in services:
            rospy.wait_for_service(command.split()[2], PATIENCE)
        for command in services:
            with self.each(command):
                status, said = self.run_there(command, PATIENCE)
                self.assertEqual(status, 0, said)
                self.assertIn(REFUSALS.get(command.split()[2], "success: True"), " ".join(re.sub(r"\\\n *\\?", " ", said).split()))
        for command in self.of("rostopic echo "):
            with self.each(command):
                status, said = self.run_there(command + " -n 1", PATIENCE)  # as it stands it never ends
                self.assertEqual(status, 0, said)
                self.assertIn("---", said)
        for command, (status, said) in self.run_all(self.of(ENDLESS.pattern), LISTENS).items():
            with self.each(command):
                self.assertIsNone(status, said)
                self.assertNotIn("rror", said)
                if command.startswith(SUBSCRIBER):
                    self.assertIn(" kPa at row ", said)


if __name__ == "__main__":
    rospy.init_node("commands_test", disable_signals=True)
    rostest.rosrun("fsr_pressure_map", "commands_test", CommandsTest, sys.argv)
