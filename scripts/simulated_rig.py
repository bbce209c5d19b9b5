"""What measure_history and measure_shape share: bags of a simulated rig of one seed, and the tools that are run on them."""

import pathlib
import subprocess
import sys

import yaml


def refuse(sentence):
    sys.exit(f"{pathlib.Path(sys.argv[0]).name}: {sentence}")


class SimulatedRig:
    """The folder seed_N of the results. `options`: output, programs, simulation (paths)."""

    def __init__(self, options, seed):
        self.options, self.seed = options, seed
        self.folder = options.output / f"seed_{seed}"
        self.folder.mkdir(parents=True, exist_ok=True)

    def run(self, program, *words):
        """What the tool prints."""
        path = self.options.programs / program
        if not path.exists():
            refuse(f"{path}: there is no such program; build it, or give --programs")
        done = subprocess.run([str(path), *map(str, words)], capture_output=True, text=True)
        if done.returncode != 0:
            refuse(done.stderr.strip() or done.stdout.strip())
        return done.stdout

    def settings(self):
        """The settings of the rig, to be changed."""
        rig = yaml.safe_load(self.options.simulation.read_text())
        if not isinstance(rig, dict) or not {"matrix", "session", "effects"} <= rig.keys():
            refuse(f"{self.options.simulation}: has no matrix, session and effects; give a simulation as in config/simulation")
        return rig

    def simulated(self, rig, name):
        """The bags of the rig, in the order of its session."""
        settings = self.folder / f"{name}.yaml"
        settings.write_text(yaml.safe_dump(rig, sort_keys=False))
        self.run("simulate", "--simulation", settings, "--seed", self.seed, "--output", self.folder / name)
        return sorted((self.folder / name).glob("*.bag"), key=lambda bag: int(bag.name.split("_")[0]))
