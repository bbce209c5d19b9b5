#!/usr/bin/python3
"""Draws the life of each sheet.

DIR holds life.json, which the tool `check_calibration` wrote. This script adds a figure for each sheet, life_SHEET.png and
life_SHEET.pdf. All numbers come from the tool; the script computes none.
"""
import argparse
import datetime
import json
import os
import re
import sys

import matplotlib.dates as dates

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import figure_style as style  # noqa: E402

LOOKS = {"recordings": {"color": style.BLUE, "marker": "o", "label": "recordings"},
         "calibrations": {"color": style.ORANGE, "marker": "s", "label": "calibrations"}}
# Name of the column in "tests", key in "rows", label, factor to the unit of the label.
PANELS = (("gain", "gain", "gain\n[1]", 1),
          ("zero", "zero", "zero\n[counts]", 1),
          ("noise", "noise", "noise\n[counts]", 1),
          ("held-out error", "held_out_error", "held-out error\n[kPa]", 1e-3),
          (None, "sheet_temperature", "temperature\n[deg C]", 1))


def day(text):
    return datetime.date.fromisoformat(text)


def course(sheet, source, key):
    """Dates and values of one source where the value is known."""
    rows = [row for row in sheet["rows"] if row["source"] == source and row[key] is not None]
    return [day(row["date"]) for row in rows], [row[key] for row in rows], rows


def draw_scatter(axes, sheet):
    """The standard deviation over the taxels, around their mean gain."""
    at, gain, rows = course(sheet, "recordings", "gain")
    known = [(x, y, row["gain_scatter"]) for x, y, row in zip(at, gain, rows) if row["gain_scatter"] is not None]
    if known:
        axes.fill_between([x for x, _, _ in known], [y - s for _, y, s in known], [y + s for _, y, s in known],
                          color=style.SKY, alpha=0.25, linewidth=0, label="taxels, one deviation")


def draw_tests(axes, sheet, name, factor):
    """What the dates before let expect, and what changed."""
    for test in sheet["tests"]:
        if test["column"] != name:
            continue
        for date in test["dates"]:
            if date["predicted"] is None:
                continue
            axes.errorbar(day(date["date"]), factor * date["predicted"], yerr=factor * date["half_width"], color="0.65",
                          elinewidth=3, alpha=0.6, zorder=1)
            if date["changed"]:
                axes.plot(day(date["date"]), factor * date["value"], "o", markersize=10, markerfacecolor="none",
                          markeredgecolor=style.RED, zorder=4)


def shown_range(axes, values, sheet, name, factor):
    """Intervals after few dates are wide; the values decide what is shown."""
    if name == "gain":
        values = values + [row["gain"] + sign * (row["gain_scatter"] or 0) for row in sheet["rows"]
                           if row["gain"] is not None for sign in (-1, 1)]
    last = [factor * (date["predicted"] + sign * date["half_width"]) for test in sheet["tests"]
            if test["column"] == name for date in test["dates"][-1:] if date["predicted"] is not None
            for sign in (-1, 1)]
    low, high = min(values + last), max(values + last)
    margin = 0.08 * (high - low) or 0.05 * abs(high) or 1
    axes.set_ylim(low - margin, high + margin)


def draw_course(axes, sheet, panel):
    name, key, label, factor = panel
    if name == "gain":
        draw_scatter(axes, sheet)
    drawn = []
    for source, look in LOOKS.items():
        at, values, _ = course(sheet, source, key)
        values = [factor * value for value in values]
        if at:
            axes.plot(at, values, markersize=3, zorder=3, **look)
        drawn += values
    draw_tests(axes, sheet, name, factor)
    shown_range(axes, drawn, sheet, name, factor)
    axes.set_ylabel(label)


def draw_taxels(axes, sheet):
    at, dead, rows = course(sheet, "recordings", "dead")
    axes.step(at, [len(taxels) for taxels in dead], where="post", color=style.BLACK, marker=".", label="dead")
    axes.step(at, [len(row["stuck"]) for row in rows], where="post", color=style.PURPLE, marker=".", label="stuck")
    for taxel in sheet["lost_taxels"]:
        axes.annotate("(%d, %d)" % (taxel["row"], taxel["column"]), (day(taxel["date"]), 0.2), fontsize=7,
                      color=style.RED, ha="left")
    axes.set_ylabel("taxels")
    axes.yaxis.get_major_locator().set_params(integer=True)
    axes.set_ylim(bottom=-0.2)
    axes.legend(loc="upper left")


def draw(sheet, folder):
    """Returns the path of the figure."""
    panels = [panel for panel in PANELS if any(row[panel[1]] is not None for row in sheet["rows"])]
    taxels = any(row["source"] == "recordings" for row in sheet["rows"])
    count = max(1, len(panels) + taxels)
    drawing, axes = style.figure(style.PAGE, 1.05 * count + 0.5, nrows=count, sharex=True, squeeze=False)
    axes = list(axes[:, 0])
    for place, panel in zip(axes, panels):
        draw_course(place, sheet, panel)
    if taxels:
        draw_taxels(axes[-1], sheet)
    if panels:
        axes[0].legend(loc="lower left", ncols=3)
    changes = {date["date"] for test in sheet["tests"] for date in test["dates"] if date["changed"]}
    for date in changes | {taxel["date"] for taxel in sheet["lost_taxels"]}:
        for place in axes:
            place.axvline(day(date), color=style.RED, linewidth=0.6, linestyle=":", zorder=0)
    locator = dates.AutoDateLocator()
    axes[-1].xaxis.set_major_locator(locator)
    axes[-1].xaxis.set_major_formatter(dates.ConciseDateFormatter(locator))
    name = sheet["sheet"] or "without serial number"
    surface = ", on " + sheet["surface"] if sheet["surface"] else ""
    axes[0].set_title("Sheet %s%s. Red: changed suddenly. Grey: what the dates before let expect" % (name, surface))
    return style.save(drawing, os.path.join(folder, "life_" + re.sub(r"[^A-Za-z0-9._-]", "_", sheet["sheet"] or "sheet")))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", metavar="DIR")
    folder = parser.parse_args().folder
    with open(os.path.join(folder, "life.json"), encoding="utf-8") as source:
        for sheet in json.load(source)["sheets"]:
            draw(sheet, folder)


if __name__ == "__main__":
    main()
