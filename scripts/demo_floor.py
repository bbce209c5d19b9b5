"""The demo's floor: the errors of a static map on the same rig without loop and creep.

`simulate` drives that rig with the pressure, the surfaces and the mounts of the demo's bags. `train --history none` makes the
best static map (scheme interpolated) from the training bags, and `export` applies it to the live runs.
"""
import csv
import shutil

import numpy
import yaml

import demo_tools

MEMORY = ("hysteresis", "creep")  # effects that a static map cannot take out


def without_memory(simulation):
    """The settings of the simulation file without loop and creep."""
    settings = yaml.safe_load(simulation.read_text())
    if not any(effect in settings["effects"] for effect in MEMORY):
        raise demo_tools.Failure(f"{simulation} enables neither of the effects {' and '.join(MEMORY)}, so that there is no floor to compare with")
    for effect in MEMORY:
        settings["effects"].pop(effect, None)
    return settings


def read_maps(table):
    """Stamps [ns] and pressures [scans x taxels] of a table that `export --to csv` wrote."""
    stamps, pressures = [], []
    with open(table, newline="") as file:
        rows = csv.reader(file)
        columns = next(rows)
        stamp, pressure = columns.index("stamp_s"), columns.index("pressure_Pa")
        last = None
        for row in rows:
            if row[stamp] != last:
                last = row[stamp]
                stamps.append(int(last.replace(".", "")))
                pressures.append([])
            pressures[-1].append(float("nan") if row[pressure] == "NA" else float(row[pressure]))
    return numpy.array(stamps), numpy.array(pressures)


class Floor:
    def __init__(self, simulation, seed, training, live, folder, logs):
        """`training` and `live`: bags of the demo in time order."""
        self.folder, self.logs = folder, logs
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        settings = folder / "simulation.yaml"
        settings.write_text(yaml.safe_dump(without_memory(simulation)))
        demo_tools.run_tool(logs / "floor_simulate.log", "simulate", "--simulation", settings, "--seed", seed, "--output", folder,
                            "--drive", *training, *live)
        self.calibration = folder / "static.h5"
        demo_tools.run_tool(logs / "floor_train.log", "train", *(folder / bag.name for bag in training), "--scheme", "interpolated",
                            "--history", "none", "--no-scores", "--output", self.calibration)

    def maps(self, bag):
        """Stamps [ns] and pressures [scans x taxels] of the static map in a live run of the demo."""
        table = self.folder / f"{bag.stem}.csv"
        demo_tools.run_tool(self.logs / f"floor_{bag.stem}.log", "export", self.folder / bag.name, "--calibration", self.calibration,
                            "--to", "csv", "--output", table)
        maps = read_maps(table)
        table.unlink()  # 14 MB
        return maps
