#!/usr/bin/python3
"""Draws what the effects of a simulated rig do.

DATA.json is what `simulate --plot` writes: readings in per cent of full scale, pressures in kPa. Writes STEM.png and
STEM.pdf with all panels, or, where panels are named, a small STEM.png with these panels alone.
"""
import argparse
import io
import json
import os
import sys

import matplotlib.pyplot as plt
from PIL import Image  # comes with matplotlib

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import figure_style as style  # noqa: E402

READING = "reading [% FS]"
CHANGE = "change of the reading [% FS]"
PRESSURE = "recorded pressure [kPa gauge]"
STYLES = ({"color": style.RED, "linewidth": 1.3}, {"color": style.BLUE, "linewidth": 0.8},
          {"color": style.GREEN, "linewidth": 0.8})
LEGEND = {"frameon": True, "framealpha": 0.8, "edgecolor": "none"}
SMALL_DPI = 100


def response(axes, data):
    """The first loading with the effects, and without them in grey."""
    for line, colour in zip(data["response"], ("0.6", style.BLUE, "0.6", style.RED)):
        without = line["label"].endswith("without")
        axes.plot(line["x"], line["y"], "--" if without else "-", color=colour, label=line["label"])
    axes.set(title="first loading, middle taxel", xlabel=PRESSURE, ylabel=READING)
    axes.legend(**LEGEND)


def loop(axes, data):
    for line, look in zip(data["loop"], STYLES):
        axes.plot(line["x"], line["y"], label=line["label"], **look)
    axes.set(title="three slow cycles, one fast", xlabel=PRESSURE, ylabel=CHANGE)
    axes.legend(**LEGEND)


def hold(axes, data):
    pressure = data["hold_pressure"][0]
    right = axes.twinx()
    right.plot([x / 60 for x in pressure["x"]], pressure["y"], color="0.8", linewidth=0.8)
    right.set_ylabel("chamber [kPa gauge]", color="0.5")
    right.tick_params(colors="0.5")
    right.spines["right"].set(visible=True, color="0.7")
    axes.set_zorder(right.get_zorder() + 1)
    axes.patch.set_visible(False)
    for line, look in zip(data["hold"], STYLES):
        axes.plot([x / 60 for x in line["x"]], line["y"], label=line["label"], **look)
    axes.set(title="step, hold, vent, rest; room warms by 5 K", xlabel="time [min]", ylabel=CHANGE)


def low(axes, data):
    """The beginning of the response, which shows a turn-on pressure or a preload."""
    response(axes, data)
    readings = [y for line in data["response"] for x, y in zip(line["x"], line["y"]) if x <= 60]
    axes.set(title="first loading, low pressures", xlim=(0, 60), ylim=(-0.5, 1.1 * max(readings)))


def beginning(axes, data):
    """The first half minute of the hold, at rest, which shows a beat."""
    for line, look in zip(data["hold"], STYLES):
        axes.plot(line["x"], line["y"], label=line["label"], **look)
    axes.set(title="at rest", xlabel="time [s]", ylabel=CHANGE, xlim=(0, 30))
    axes.legend(loc="upper right", **LEGEND)


def rows_of(axes, rows, title, change):
    """A map with few steps of colour, which are easy to distinguish and make small files."""
    if change:
        largest = max(max(abs(value) for value in row) for row in rows) or 1
        colours = {"cmap": plt.get_cmap("RdBu_r", 21), "vmin": -largest, "vmax": largest}
    else:
        colours = {"cmap": plt.get_cmap("viridis", 20), "vmin": 0}
    image = axes.imshow(rows, **colours)  # row 0 on top, as arrays are printed
    axes.set(title=title, xlabel="column", ylabel="row")
    axes.figure.colorbar(image, ax=axes, shrink=0.8).set_label(CHANGE if change else READING)


def disc(axes, data):
    rows_of(axes, data["disc"], "under a disc of 300 kPa", False)


def disc_change(axes, data):
    rows_of(axes, data["disc_change"], "largest change under the disc", True)


def gas_change(axes, data):
    rows_of(axes, data["gas_change"], "largest change under gas to 300 kPa", True)


PANELS = {panel.__name__: panel for panel in (response, loop, hold, disc, disc_change, gas_change)}
DETAILS = {panel.__name__: panel for panel in (low, beginning)}


def save_small(drawing, path):
    """Writes a small file with few colours, under a temporary name first so that no incomplete file remains."""
    picture = io.BytesIO()
    drawing.savefig(picture, format="png", dpi=SMALL_DPI)
    plt.close(drawing)
    Image.open(picture).convert("RGB").quantize(128).save(path + ".new", format="png", optimize=True)
    os.replace(path + ".new", path)


def draw(data, stem, names=()):
    columns = len(names) or 3
    rows = 1 if names else 2
    drawing, axes = style.figure(3 * columns, 2.35 * rows + 0.2, nrows=rows, ncols=columns)
    drawing.suptitle(data["title"], fontsize=10)
    for name, place in zip(names or PANELS, axes.flat):
        (PANELS | DETAILS)[name](place, data)
    return save_small(drawing, stem + ".png") if names else style.save(drawing, stem)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", metavar="DATA.json")
    parser.add_argument("stem", metavar="STEM")
    parser.add_argument("panels", metavar="PANEL", nargs="*", help=", ".join(PANELS | DETAILS))
    arguments = parser.parse_args()
    unknown = set(arguments.panels) - set(PANELS | DETAILS)
    if unknown:
        parser.error("unknown panel: " + ", ".join(sorted(unknown)))
    with open(arguments.data, encoding="utf-8") as source:
        data = json.load(source)
    draw(data, arguments.stem, arguments.panels)


if __name__ == "__main__":
    main()
