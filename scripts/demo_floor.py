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
    """For each bag in a table that `export --to csv` wrote: stamps [ns] and pressures [scans x taxels]."""
    maps = {}
    with open(table, newline="") as file:
        rows = csv.reader(file)
        columns = next(rows)
        bag, stamp, pressure = (columns.index(name) for name in ("bag", "stamp_s", "pressure_Pa"))
        last = None
        for row in rows:
            stamps, pressures = maps.setdefault(row[bag], ([], []))
            if (row[bag], row[stamp]) != last:
                last = row[bag], row[stamp]
                stamps.append(int(row[stamp].replace(".", "")))
                pressures.append([])
            pressures[-1].append(float("nan") if row[pressure] == "NA" else float(row[pressure]))
    return {name: tuple(map(numpy.array, values)) for name, values in maps.items()}


def floor_maps(simulation, seed, training, live, folder, logs):
    """For each live run, by the name of its bag: stamps [ns] and pressures [scans x taxels] of the static map. `training` and
    `live`: bags of the demo in time order."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    settings, calibration, table = (folder / name for name in ("simulation.yaml", "static.h5", "maps.csv"))
    settings.write_text(yaml.safe_dump(without_memory(simulation)))
    demo_tools.run_tool(logs / "floor_simulate.log", "simulate", "--simulation", settings, "--seed", seed, "--output", folder,
                        "--drive", *training, *live)
    demo_tools.run_tool(logs / "floor_train.log", "train", *(folder / bag.name for bag in training), "--scheme", "interpolated",
                        "--history", "none", "--no-scores", "--output", calibration)
    demo_tools.run_tool(logs / "floor_export.log", "export", *(folder / bag.name for bag in live), "--calibration", calibration,
                        "--to", "csv", "--output", table)
    maps = read_maps(table)
    table.unlink()  # 100 MB
    return maps
