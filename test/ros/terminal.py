"""What the tests of launch files and nodes share: where the programs are, terminals, and waiting."""
import os
import pathlib
import signal
import subprocess
import tempfile
import time
import xmlrpc.client

import rosgraph
import rospkg

PACKAGE = pathlib.Path(rospkg.RosPack().get_path("fsr_pressure_map"))
PROGRAMS = pathlib.Path(os.environ["CMAKE_PREFIX_PATH"].split(":")[0]) / "lib" / "fsr_pressure_map"
PATIENCE = 60  # [s]


def happens(condition, ended=lambda: False, patience=PATIENCE):
    """Whether the condition becomes true before `ended` does, within so many seconds."""
    give_up = time.monotonic() + patience
    while not condition():
        if ended() or time.monotonic() > give_up:
            return False
        time.sleep(0.02)  # what is waited for sends no events
    return True


def pid_of(node):
    """Raises if there is no such node: a signal to process 0 would end the test itself."""
    return xmlrpc.client.ServerProxy(rosgraph.Master("/tests").lookupNode(node)).getPid("/tests")[2]


def pid_if_running(node):
    """0 if there is no such node."""
    try:
        return pid_of(node)
    except (rosgraph.MasterException, OSError):
        return 0


class Terminal:
    """One terminal: roslaunch with a shipped launch file, called in `folder`."""

    def __init__(self, folder, name, *arguments):
        self.output = tempfile.NamedTemporaryFile("a")
        environment = {**os.environ, "PWD": str(folder), "ROS_HOME": str(folder / "ros_home")}
        self.launch = subprocess.Popen(["roslaunch", "fsr_pressure_map", f"{name}.launch", *arguments], cwd=folder,
                                       env=environment, stdout=self.output, stderr=subprocess.STDOUT)

    def ended(self):
        return self.launch.poll() is not None

    def said(self):
        return pathlib.Path(self.output.name).read_text()  # not by the descriptor, which has the place where roslaunch writes

    def end(self):
        """Ctrl-C; what the terminal then shows."""
        if not self.ended():
            self.launch.send_signal(signal.SIGINT)
        self.launch.wait(PATIENCE)
        return self.said()
