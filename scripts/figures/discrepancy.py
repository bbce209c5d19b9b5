#!/usr/bin/python3
"""Draws the figures of a discrepancy run and writes its report.

DIR holds results.json and figures/*.csv, which the tool `discrepancy` wrote. This script adds figures/*.png and report.html.
All numbers come from the tool; the script computes none.
"""

import argparse
import csv
import html
import json
import math
import os

import figure_style as style
import matplotlib.pyplot as plt

# Order of the covariates' curves if the verdict names none.
ORDER = ["pressure", "direction", "time_since_reversal", "pressure_rate", "cycle", "clock_time", "temperature"]
SCALES = {"Pa": (1e-3, "kPa"), "Pa/s": (1e-3, "kPa/s")}  # units on screens
WORDS = {
    "named": "named", "none": "nothing is missing", "unknown": "unknown: no effect of the library explains the gap",
    "ambiguous": "ambiguous: several explanations remain", "wrong_form": "right effect, wrong form",
    "not_identifiable": "not identifiable under this protocol",
}
SITUATIONS = {"ramp": "in a ramp", "stance": "in a stance of 0.6 s", "standing": "in ten minutes of standing"}

LAYOUT = """<style>
.first { display: grid; grid-template-columns: minmax(20em, 2fr) 3fr; gap: 0 1.6em; }
.first figure { margin: 0.8em 0 0; } .first p, .first ul { margin: 0.4em 0; } .first .verdict { grid-column: 1 / 3; margin: 0; }
body { max-width: 76em; margin: 1em auto; } h1 { margin: 0.3em 0; }
.gap td { padding: 0.15em 0.7em; } dt { font-weight: bold; margin-top: 0.5em; } dd { margin: 0; } dd pre { margin: 0; white-space: pre-wrap; }
@media (max-width: 50em) { .first { display: block; } }
</style>"""


def read_table(path):
    """{heading: [cells]}; a cell is a number if it can be read as one, and NaN if it is empty."""
    with open(path, newline="", encoding="utf-8") as table:
        rows = list(csv.reader(table))

    def cell(text):
        try:
            return float(text) if text else math.nan
        except ValueError:
            return text
    return {heading: [cell(row[i]) for row in rows[1:]] for i, heading in enumerate(rows[0])}


def spelt(name):
    return name.replace("_", " ")


# --- figures ----------------------------------------------------------------------------------------


def curves(folder, results):
    """Tables of residual curves; those on which the residual depends come first."""
    names = [curve["covariate"] for curve in results["curves"] if curve["at"]]
    first = [name for name in results["depends_on"] if name in names]
    rest = sorted(set(names) - set(first), key=lambda n: (ORDER.index(n) if n in ORDER else len(ORDER), n))
    return [(name, read_table(os.path.join(folder, "residual_%s.csv" % name))) for name in first + rest]


def branches(name, at):
    """[(style, rows)]: one curve, or one each for loading and unloading if unloading has negative pressure."""
    if name != "direction" or max(at) <= 1:
        return [("-", range(len(at)))]
    up, down = ([i for i, x in enumerate(at) if (x >= 0) == side] for side in (True, False))
    return [(line, rows) for line, rows in (("-", up), ("--", down)) if rows]


def draw_curve(axes, name, table):
    heading, before, after, error = list(table)[:4]
    unit = heading[len(name):].strip(" []")
    factor, shown = SCALES.get(unit.split(",")[0], (1, unit))
    at = [factor * x for x in table[heading]]
    parts = branches(name, at)
    axes.axhline(0, color="#999999", linewidth=0.6)
    for column, colour, label in ((before, style.RED, "before"), (after, style.BLUE, "after")):
        for line, rows in parts:
            x = [abs(at[i]) if len(parts) > 1 else at[i] for i in rows]
            mean = [table[column][i] for i in rows]
            band = [1.96 * table[error][i] for i in rows]
            axes.fill_between(x, [m - e for m, e in zip(mean, band)], [m + e for m, e in zip(mean, band)],
                              color=colour, alpha=0.2, linewidth=0)
            axes.plot(x, mean, line, color=colour, marker="." if len(at) < 30 else None,
                      label=label if line == "-" else None)
    axes.set_title("Residual by %s" % spelt(name))
    axes.set_xlabel(spelt(name) + (" [%s]" % shown if shown else ""))
    if len(parts) > 1:
        axes.set_xlabel("pressure [kPa]; solid: filling, dashed: venting")
    elif name == "direction":
        axes.set_xticks([-1, 1], ["unloading", "loading"])


def draw_gap(axes, table):
    names = [row for row, value in zip(table["gap"], table["rms [% FS]"]) if not math.isnan(value)]
    colours = {"before": style.RED, "after": style.BLUE, "floor": "#888888"}
    for i, name in enumerate(names):
        row = table["gap"].index(name)
        value, low, high = (table[c][row] for c in ("rms [% FS]", "low [% FS]", "high [% FS]"))
        axes.bar(i, value, color=colours[name], width=0.7)
        if low < high:
            axes.errorbar(i, value, yerr=[[max(0, value - low)], [max(0, high - value)]], color="black", capsize=3)
        pressure = table["rms [Pa]"][row]
        text = "%.2g %%" % value + ("" if math.isnan(pressure) else "\n%.3g kPa" % (pressure / 1e3))
        axes.annotate(text, (i, max(value, high if low < high else value)), ha="center", va="bottom", fontsize=7,
                      xytext=(0, 2), textcoords="offset points")
    axes.set_xticks(range(len(names)), names)
    axes.margins(y=0.25)
    axes.set_title("Gap on hold-out data")
    axes.set_ylabel("gap, rms [% of full scale]")


def draw_first(folder, results):
    """One picture: the disagreement before and after, and its size."""
    tables = curves(folder, results)[:2]
    drawing, axes = plt.subplots(1, len(tables) + 1, figsize=(style.PAGE, 2.9),
                                 width_ratios=[3] * len(tables) + [2])
    axes = list(axes) if tables else [axes]
    for other in axes[1:len(tables)]:
        other.sharey(axes[0])  # so that sizes can be compared
    for i, (name, table) in enumerate(tables):
        draw_curve(axes[i], name, table)
    if tables:
        axes[0].set_ylabel("measured - simulated [% of full scale]")
        axes[0].legend(loc="best")
    draw_gap(axes[-1], read_table(os.path.join(folder, "gap.csv")))
    return style.save(drawing, os.path.join(folder, "disagreement"))


def draw_rest(folder, results):
    """All other curves, three in a row; None if there are none."""
    tables = curves(folder, results)[2:]
    if not tables:
        return None
    rows = (len(tables) + 2) // 3
    drawing, axes = plt.subplots(rows, 3, figsize=(style.PAGE, 2.0 * rows), squeeze=False)
    places = [place for row in axes for place in row]
    for place, (name, table) in zip(places, tables):
        draw_curve(place, name, table)
    for place in places[len(tables):]:
        place.set_visible(False)
    for row in axes:
        row[0].set_ylabel("measured - simulated\n[% of full scale]")
    return style.save(drawing, os.path.join(folder, "covariates"))


def draw_candidates(folder):
    """What each candidate adds to the predictive density of held-out cycles; None if there is no candidate."""
    table = read_table(os.path.join(folder, "candidates.csv"))
    number = min(len(table["explanation"]), 15)
    if number == 0:
        return None
    drawing, axes = style.figure(style.PAGE, 0.5 + 0.2 * number)
    shown = {"named": style.GREEN, "credible": style.ORANGE}
    nats = [max(0, s) if not math.isnan(s) else 0 for s in table["nats"][:number]]
    axes.barh(range(number), nats, color=[shown.get(o, "#bbbbbb") for o in table["outcome"][:number]])
    axes.set_yticks(range(number), [spelt(str(e)) for e in table["explanation"][:number]])
    axes.invert_yaxis()
    axes.set_xlabel("added to the log density of cycles that it was not fitted to [nats]")
    for i, outcome in enumerate(table["outcome"][:number]):
        axes.annotate(spelt(str(outcome)), (nats[i], i), va="center", fontsize=6.5, xytext=(3, 0),
                      textcoords="offset points")
    axes.margins(x=0.15)
    return style.save(drawing, os.path.join(folder, "candidates"))


# --- the page ---------------------------------------------------------------------------------------


def percent(value):
    return "-" if value is None else ("%#.3g" % (100 * value)).rstrip(".") + " %"


def kilopascal(value):
    return "-" if value is None else "%.3g kPa" % (value / 1e3)


def probability(value):
    return "-" if value is None else "%.2g" % value


def gap_table(gap, added):
    if gap["before"] is None:
        return style.paragraph("The gap was not measured, because nothing was held out.")
    def interval(name):
        low, high = gap[name + "_interval"]
        return "" if low is None or not low < high else "%s to %s" % (percent(low), percent(high))
    rows = [(name, percent(gap[name]), interval(name), kilopascal(gap[name + "_pa"]))
            for name in (("before", "after", "floor") if added else ("before", "floor"))]
    rows.append(("differences between cycles", percent(gap["floor_bracket"][1]), "", ""))
    if gap["closed"] is not None:
        rows.append(("closed", percent(gap["closed"]), interval("closed"), ""))
    return style.table(["gap", "of full scale", "95 % interval", "gauge pressure"], rows)


def sentence_list(sentences):
    return "<ul>%s</ul>" % "".join("<li>%s</li>" % html.escape(s) for s in sentences)


def item(title, text):
    return "<dt>%s</dt><dd>%s</dd>" % (html.escape(title), html.escape(text))


def not_testable(results):
    def one(effect):
        experiment = effect["experiment"]
        return spelt(effect["id"]) + (" (%s)" % spelt(experiment) if experiment and experiment != "none" else "")
    return ", ".join(one(e) for e in results["not_identifiable"]) or "none"


def held_out(gap):
    explained = {held["by"]: " (%s of the common trace explained)" % percent(held["closed"]) for held in gap["foretold"]}
    parts = ", ".join(by + explained.get(by, "") for by in gap["held_out_by"]) or "nothing"
    return parts + (" (weak evidence: only cycles)" if gap["held_out_by"] == ["cycles"] else "")


def foretold_section(results):
    rows = [(held["by"], part["part"], percent(part["closed"]))
            for held in results["gap"]["foretold"] for part in held["parts"]]
    return [style.paragraph("Share of the common trace that the effects found explain on data held out; their sizes were fitted to "
                            "all other data:"),
            style.table(["held out", "", "explained"], rows)] if rows else []


def surfaces_section(results):
    rows = [(s["surface"], percent(s["before"]), percent(s["after"])) for s in results["gap"]["surfaces"]]
    return [style.table(["surface", "gap before", "gap after"], rows)] if rows else []


def opened(results):
    most = max((i["show_opened"] for i in results["inputs"]), default=0)
    return "once" if most <= 1 else "%d times by now" % most


def verdict_words(results):
    if results["verdict"] == "unknown" and results["gap"]["before"] is None:
        return "unknown: nothing was held out, so no name can be proved"
    return WORDS.get(results["verdict"], results["verdict"])


def first_screen(results, figure):
    """The answers of the tool, in its order. The verdict stands above them, the gap is a table below them."""
    items = results["first_screen"]
    missing = [i["title"] for i in items].index("Missing")
    larger = "".join("<b>%s.</b> %s<br>" % (html.escape(i["title"]), html.escape(i["answer"])) for i in items[:missing])
    answers = items[missing + 1:]
    facts = "".join(
        "<dt>%s</dt><dd>%s</dd>" % (html.escape(i["title"]),
                                    ("<pre>%s</pre>" if i["title"].startswith("Recompute") else "%s") % html.escape(i["answer"]))
        for i in answers)
    facts += item("Not testable here (what would show it)", not_testable(results))
    facts += item("Held out by", held_out(results["gap"]) + "; looked at " + opened(results))
    caption = ("Measured minus simulated: mean with 95 % interval, before and after the effects found were added, "
               "and its rms on hold-out data. Floor: noise from differences between neighbouring scans")
    return ("<div class=first><p class=verdict>%s<b>%s.</b> %s</p><div><dl>%s</dl><div class=gap>%s</div></div>%s</div>"
            % (larger, html.escape(verdict_words(results).capitalize()),
               html.escape(results["sentence"]), facts, gap_table(results["gap"], results["effects"]), style.picture(figure, caption)))


def effects_section(results):
    rows = []
    for effect in results["effects"]:
        for p in effect["parameters"] or [None]:
            low, high = p["interval"] if p else (None, None)
            rows.append((spelt(effect["id"]), p["name"] if p else "", p["value"] if p else "", p["unit"] if p else "",
                         "" if low is None else "%.4g to %.4g" % (low, high), effect["z"], effect["share_of_ceiling"]))
    pieces = [style.paragraph("%s: %s" % (spelt(e["id"]), e["summary"])) for e in results["effects"]]
    if rows:
        pieces.append(style.table(["effect", "parameter", "value", "unit", "95 % interval", "z", "share of explainable part"],
                                  rows))
    if any(e["id"] == "creep" for e in results["effects"]):
        pieces.append(style.paragraph("Data sheets call creep \"drift under constant load\"."))
    return pieces


def where_section(results):
    where = results["where"]
    low, high = where["pressure_pa"]
    rows = [("taxels", ", ".join(map(str, where["taxels"])) or "all"),
            ("surfaces", ", ".join(where["conditions"]) or "all"),
            ("gauge pressure", "all" if low is None else "%s to %s" % (kilopascal(low), kilopascal(high))),
            ("direction", where["direction"]),
            ("time", ", ".join("%.0f to %.0f s" % tuple(t) for t in where["times_s"]) or "all"),
            ("depends on", ", ".join(spelt(c) for c in results["depends_on"]) or "-")]
    return [style.table(["where", ""], rows)]


def covariates_section(results):
    methods = {"predictive_density": "terms of the covariate", "effect": "effect found", "detector": "test of its own",
               "static_curves": "static curves", "odd_taxels": "taxels that differ"}
    rows = [(spelt(t["covariate"]), "yes" if t["depends"] else "no", probability(t["p"]), probability(t["adjusted_p"]),
             kilopascal(t["at_map_pa"]), methods.get(t["method"], t["method"])) for t in results["covariates"]]
    options = results["options"]
    return [style.paragraph("Terms of each covariate compete with the effects: what they add to the predictive density of cycles that they "
                            "were not fitted to. The adjusted p is corrected for the search among all explanations. Yes: the adjusted p "
                            "is at most %.2g, and the size at the map at least %s; or what was found depends on the covariate."
                            % (options["level"], kilopascal(results["least_gap_pa"]))),
            style.table(["covariate", "depends", "p", "adjusted p", "rms at the map", "by"], rows)] if rows else []


def seen_section(results):
    seen = sorted((s for s in results["smallest_seen"] if s["at_map_pa"] is not None), key=lambda s: s["at_map_pa"])
    return [style.paragraph("Each of these effects would have been seen from this size on, if nothing else were missing; never below the "
                            "least gap of %s." % kilopascal(results["least_gap_pa"])),
            style.table(["effect", "rms at the map"], [(spelt(s["id"]), kilopascal(s["at_map_pa"])) for s in seen])] if seen else []


def scatter_section(results):
    names = {"cycle_gain": "gain, from cycle to cycle", "cycle_offset": "zero, from cycle to cycle", "wandering": "slow wandering within a cycle"}
    rows = [(names.get(s["part"], s["part"]), percent(s["size"]), "%s to %s" % (percent(s["interval"][0]), percent(s["interval"][1])),
             s["unit"], kilopascal(s["at_map_pa"]), percent(s["share_of_noise"])) for s in results["scatter"]]
    return [style.paragraph("Standard deviation of the mean reading of all taxels. An interval from 0 means: not to be told from none."),
            style.table(["scatter", "size", "95 % interval", "of", "rms at the map", "share of the noise"], rows)] if rows else []


def options_section(results):
    def text(value):
        return "-" if value is None else "%g" % value
    return [style.table(["constant of the decision", "value"], [(spelt(k), text(v)) for k, v in results["options"].items()])]


def use_section(results):
    rows = [(SITUATIONS.get(u["situation"], u["situation"]), kilopascal(u["before_pa"]), kilopascal(u["after_pa"]))
            for u in results["in_use"]]
    return [style.paragraph("Before: with static curves only. After: with the effects found."),
            style.table(["largest error", "before", "after"], rows)] if rows else []


def provenance(results):
    rows = [(i["file"], i["sha256"], i["scans"], i["show_opened"]) for i in results["inputs"]]
    tested = ", ".join(spelt(t) for t in results["tested"])
    return [style.table(["bag", "SHA-256", "scans", "looks at the hold-out part"], rows),
            style.paragraph("Started from the simulation \"%s\"; seed %d; version %s. Effects tested: %s." %
                            (results["simulation"], results["seed"], results["version"], tested or "none")),
            style.paragraph("Research use. Not for diagnosis or fitting decisions.")]


def sections(results, figures):
    def pictures(*pairs):
        return [style.picture(path, caption) for path, caption in pairs if path]
    testable = [(spelt(e["id"]), spelt(e["experiment"]), e["reason"]) for e in results["not_identifiable"]]
    shown = results["verdict"] not in ("none", "not_identifiable")
    parts = [
        (None, [LAYOUT, first_screen(results, figures["first"])]),
        ("What was found", effects_section(results) + [style.paragraph(s["sentence"]) for s in results["steps"]]),
        ("Where it appears", where_section(results) if shown else []),
        ("What the residual depends on", covariates_section(results)),
        ("What would have been seen", seen_section(results)),
        ("Scatter", scatter_section(results)),
        ("Gap on each surface", surfaces_section(results)),
        ("Hold-out surfaces and protocols", foretold_section(results)),
        ("Largest errors in use", use_section(results)),
        ("All candidates", pictures((figures["candidates"], "The best explanations, alone or in pairs. Green: "
                                     "named, orange: not excluded, grey: refused"))),
        ("Other covariates", pictures((figures["rest"], "The same residual over all other covariates"))),
        ("Not testable with these bags", [style.table(["effect", "experiment that would show it", "reason"], testable)] if testable else []),
        ("Limits", [sentence_list(results["limitations"] + results["gap"]["missing"])]
         if results["limitations"] or results["gap"]["missing"] else []),
        ("Constants", options_section(results)),
        ("Provenance", provenance(results)),
    ]
    return [(heading, pieces) for heading, pieces in parts if pieces]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", metavar="DIR")
    folder = parser.parse_args().folder
    with open(os.path.join(folder, "results.json"), encoding="utf-8") as file:
        results = json.load(file)
    figures = os.path.join(folder, "figures")
    drawn = {"first": draw_first(figures, results), "rest": draw_rest(figures, results),
             "candidates": draw_candidates(figures)}
    style.page(os.path.join(folder, "report.html"), "Simulation against measurement", sections(results, drawn))


if __name__ == "__main__":
    main()
