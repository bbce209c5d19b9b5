"""Tools of the package, as the demo calls them."""
import subprocess


class Failure(Exception):
    """The demo cannot go on. The text says why and where to look."""


def run_tool(log, tool, *words):
    """Runs `rosrun fsr_pressure_map TOOL WORDS...` with its output in the file `log`, and returns the output."""
    with open(log, "w") as file:
        command = ["rosrun", "fsr_pressure_map", tool, *map(str, words)]
        done = subprocess.run(command, stdout=file, stderr=subprocess.STDOUT)
    said = log.read_text()
    if done.returncode != 0:
        raise Failure(f"{tool} failed: {(said.strip().splitlines() or ['it said nothing'])[-1]}")
    return said
