"""What the parts of the demo share: processes, and tools of the package."""
import contextlib
import signal
import subprocess
import time

START_LIMIT = 60.0  # time for a process to start before the demo gives up [s]


class Failure(Exception):
    """The demo cannot go on. The text says why and where to look."""


@contextlib.contextmanager
def process(command, log, stop_signal=signal.SIGINT, **keywords):
    """A child process with its output in `log`. It is ended when the block is left."""
    with open(log, "w") as output:
        child = subprocess.Popen(command, stdout=output, stderr=subprocess.STDOUT, start_new_session=True, **keywords)
        try:
            yield child
        finally:
            if child.poll() is None:
                child.send_signal(stop_signal)
            try:
                child.wait(30)
            except subprocess.TimeoutExpired:
                child.kill()
                child.wait()


def wait_until(condition, child, what, log):
    """Polls `condition` while `child` runs. (The ROS graph sends no events to wait for.)"""
    give_up = time.monotonic() + START_LIMIT
    while not condition():
        if child.poll() is not None:
            raise Failure(f"{what} ended unexpectedly; its log is {log}")
        if time.monotonic() > give_up:
            raise Failure(f"{what} did not start within {START_LIMIT:.0f} s; its log is {log}")
        time.sleep(0.05)


def serves(service):
    """Whether a node offers the service, a full name."""
    import rosgraph
    return any(name == service for name, _ in rosgraph.Master("/demo").getSystemState()[2])


def run_tool(log, tool, *words):
    """Runs `rosrun fsr_pressure_map TOOL WORDS...` with its output in the file `log`, and returns the output."""
    with open(log, "w") as file:
        command = ["rosrun", "fsr_pressure_map", tool, *map(str, words)]
        done = subprocess.run(command, stdout=file, stderr=subprocess.STDOUT)
    said = log.read_text()
    if done.returncode != 0:
        raise Failure(f"{tool} failed: {(said.strip().splitlines() or ['it said nothing'])[-1]}")
    return said
