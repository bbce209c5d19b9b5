#!/usr/bin/python3
"""Draws what the effects of a simulated rig do: plot_simulation.py DATA.json PICTURE.png

The data are those that `simulate --plot` writes: readings in per cent of full scale, pressures in kPa.
"""
import io
import json
import os
import sys

import matplotlib

matplotlib.use("Agg")  # no X needed
import matplotlib.pyplot as plt  # noqa: E402
from PIL import Image  # noqa: E402  comes with matplotlib

READING = "reading [% FS]"
CHANGE = "change of the reading [% FS]"
PRESSURE = "recorded pressure [kPa gauge]"
STYLES = [{"color": "C3", "linewidth": 1.2}, {"color": "C0", "linewidth": 0.8}, {"color": "C2", "linewidth": 0.8}]


def draw_response(axes, data):
    for line in data["response"]:
        without = line["label"].endswith("without")
        axes.plot(line["x"], line["y"], "--" if without else "-", color="0.6" if without else None,
                  label=line["label"], linewidth=1.2)
    axes.set(title="first loading, middle taxel", xlabel=PRESSURE, ylabel=READING)
    axes.legend(fontsize=7)


def draw_loop(axes, data):
    for line, style in zip(data["loop"], STYLES):
        axes.plot(line["x"], line["y"], label=line["label"], **style)
    axes.set(title="three slow cycles, one fast", xlabel=PRESSURE, ylabel=CHANGE)
    axes.legend(fontsize=7)


def draw_hold(axes, data):
    pressure = data["hold_pressure"][0]
    right = axes.twinx()
    right.plot([x / 60 for x in pressure["x"]], pressure["y"], color="0.85", linewidth=0.8)
    right.set_ylabel("chamber [kPa gauge]", color="0.5")
    right.tick_params(colors="0.5")
    axes.set_zorder(right.get_zorder() + 1)
    axes.patch.set_visible(False)
    for line, style in zip(data["hold"], STYLES):
        axes.plot([x / 60 for x in line["x"]], line["y"], **style)
    axes.set(title="step, hold, vent, rest; room warms by 5 K", xlabel="time [min]", ylabel=CHANGE)


def draw_map(figure, axes, rows, title, change):
    if change:
        largest = max(max(abs(value) for value in row) for row in rows) or 1
        colours = {"cmap": "RdBu_r", "vmin": -largest, "vmax": largest}
    else:
        colours = {"cmap": "viridis", "vmin": 0}
    image = axes.imshow(rows, **colours)  # row 0 on top, as arrays are printed
    axes.set(title=title, xlabel="column", ylabel="row")
    figure.colorbar(image, ax=axes, shrink=0.75).set_label(CHANGE if change else READING, fontsize=8)


def save(figure, path):
    """Few colours make a small file; a new name at first, so that nothing half-written remains."""
    picture = io.BytesIO()
    figure.savefig(picture, format="png")
    fresh = path + ".new"
    Image.open(picture).convert("RGB").quantize(96).save(fresh, format="png", optimize=True)
    os.replace(fresh, path)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    with open(sys.argv[1], encoding="utf-8") as source:
        data = json.load(source)
    plt.rcParams.update({"font.size": 8, "axes.titlesize": 9})
    figure, axes = plt.subplots(2, 3, figsize=(11.5, 6), dpi=75)
    figure.suptitle(data["title"], fontsize=12)
    draw_response(axes[0][0], data)
    draw_loop(axes[0][1], data)
    draw_hold(axes[0][2], data)
    draw_map(figure, axes[1][0], data["disc"], "under a disc of 300 kPa", False)
    draw_map(figure, axes[1][1], data["disc_change"], "largest change under the disc", True)
    draw_map(figure, axes[1][2], data["gas_change"], "largest change under gas, up to 300 kPa", True)
    figure.tight_layout()
    save(figure, sys.argv[2])


if __name__ == "__main__":
    main()
