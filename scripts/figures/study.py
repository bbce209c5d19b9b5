#!/usr/bin/python3
"""Draws the figures of a study and writes its report. FOLDER holds results.json and tables/.

Writes figures/*.png, *.pdf and *.csv, like Figs 5 to 10 of the paper (C. Ahmadizadeh, C. Menon, Sensors 2019, 19(24), 5519,
https://doi.org/10.3390/s19245519), and report.html.
"""

import argparse
import csv
import json
import os

import figure_style as style

SHOWN_BY_PRESSURE = ("baseline", "per_curvature", "flat_or_curved", "curvature_map")
ONE_LINE = 200  # schemes whose RMSE differs by less than this share a line in the figure of curvature errors [Pa]
PAPER_ALGORITHM = {"linear": "LR", "grnn": "GRNN", "forest": "RF"}
PAPER = ("\"The paper\": C. Ahmadizadeh, C. Menon, \"Investigation of Regression Methods for Reduction of Errors Caused by "
         "Bending of FSR-Based Pressure Sensing Systems Used for Prosthetic Applications\", Sensors 2019, 19(24), 5519, "
         "doi 10.3390/s19245519.")
NOT_FOR_PATIENTS = "Research use. Not for diagnosis or fitting decisions."


def read_table(folder, name):
    """{heading: values}; a column is numbers if all its values are."""
    with open(os.path.join(folder, "tables", name), newline="", encoding="utf-8") as table:
        rows = list(csv.DictReader(table))
    columns = {}
    for heading in rows[0] if rows else []:
        values = [row[heading] for row in rows]
        try:
            columns[heading] = [float(value) for value in values]
        except ValueError:
            columns[heading] = values
    return columns


def plain_name(score):
    """A score's name, e.g. "per curvature (Method 1)"."""
    name = score["id"].replace("_", " ")
    return f"{name} ({score['label']})" if score["paper"] and score["label"].startswith("Method") else name


def radius(curvature):
    """The radius of a curvature [1/m], as text."""
    if abs(curvature) < 0.25:
        return "flat"
    return f"{100 / abs(curvature):.0f} cm" + (" inside" if curvature < 0 else "")


def curves(response):
    """[(curvature, times, pressures, readings)] by ascending magnitude of the curvature."""
    kept = {}
    for surface, curvature, *values in zip(*(response[name] for name in (
            "surface", "curvature [1/m]", "time [s]", "pressure [kPa]", "reading [counts]"))):
        kept.setdefault((curvature, surface), []).append(values)
    ordered = sorted(kept.items(), key=lambda item: abs(item[0][0]))
    return [(curvature, *map(list, zip(*rows))) for (curvature, _), rows in ordered]


def response_columns(chosen, highest):
    columns = {"radius": [], "pressure [kPa]": [], "reading [counts]": []}
    for curvature, _, pressures, readings in chosen:
        for pressure, reading in zip(pressures, readings):
            if pressure <= highest:
                columns["radius"].append(radius(curvature))
                columns["pressure [kPa]"].append(pressure)
                columns["reading [counts]"].append(reading)
    return columns


def medians(points):
    """Median reading in equal bins of pressure, as a guide for the eye."""
    low, high = min(p for p, _ in points), max(p for p, _ in points)
    bins = max(3, min(16, sum(p > low + 0.02 * (high - low) for p, _ in points) // 12))
    lists = [[] for _ in range(bins)]
    for pressure, reading in points:
        lists[min(bins - 1, int(bins * (pressure - low) / (high - low)))].append((pressure, reading))
    middle = [sorted(part, key=lambda point: point[1])[len(part) // 2][1] for part in lists if part]
    places = [sum(p for p, _ in part) / len(part) for part in lists if part]
    return places, middle


def draw_response(stem, chosen, highest=float("inf"), width=style.COLUMN, height=2.4):
    drawing, axes = style.figure(width, height)
    for number, (curvature, _, pressures, readings) in enumerate(chosen):
        kept = [(p, r) for p, r in zip(pressures, readings) if p <= highest]
        if not kept:  # a section of few cycles may never be at low pressure
            continue
        name = radius(curvature)
        colour = style.COLOURS[number % len(style.COLOURS)]
        axes.plot([p for p, _ in kept], [r for _, r in kept], ".", markersize=1.6, alpha=0.35, color=colour,
                  rasterized=True)
        axes.plot(*medians(kept), "-", color=colour, label=name)
    axes.set(xlabel="chamber pressure [kPa gauge]", ylabel="reading [counts]")
    if axes.get_lines():
        axes.legend(title="radius; line: median", loc="best")
    return style.save(drawing, stem, response_columns(chosen, highest))


def boxes(axes, values, names, label):
    axes.boxplot(values, widths=0.55, medianprops={"color": style.RED}, flierprops={"marker": ".", "markersize": 3})
    axes.set_xticklabels(names)
    axes.set_ylabel(label)


def box_columns(scores):
    columns = {"method": [], "taxel": [], "R2": [], "RMSE [%]": []}
    for score in scores:
        for taxel, (r2, percent) in enumerate(zip(score["taxels"]["r2"], score["taxels"]["rmse_percent"])):
            columns["method"].append(score["label"])
            columns["taxel"].append(taxel)
            columns["R2"].append(r2)
            columns["RMSE [%]"].append(percent)
    return columns


def draw_boxes(stem, scores, names, stacked):
    drawing, pair = style.figure(style.COLUMN if stacked else style.PAGE, 4.2 if stacked else 2.4,
                                 nrows=2 if stacked else 1, ncols=1 if stacked else 2)
    boxes(pair[0], [score["taxels"]["rmse_percent"] for score in scores], names, "RMSE [% of range]")
    boxes(pair[1], [score["taxels"]["r2"] for score in scores], names, "R²")
    return style.save(drawing, stem, box_columns(scores))


def one_cycle(table):
    """The range of a prediction that shows one cycle, from the rest before the first filling to the next rest."""
    pressure = table["reference [kPa]"]
    level = 0.02 * max(pressure)
    above = [i for i, value in enumerate(pressure) if value > level]
    first = above[0]
    last = next((i for i in range(first, len(pressure)) if pressure[i] <= level), len(pressure) - 1)
    margin = max(5, (last - first) // 10)
    return max(0, first - margin), min(len(pressure), last + margin)


def draw_prediction(stem, table, curvature):
    begin, end = one_cycle(table)
    part = {name: values[begin:end] for name, values in table.items()}
    drawing, axes = style.figure(style.PAGE, 2.8)
    axes.plot(part["time [s]"], part["without curvature [kPa]"], ".", color=style.RED, markersize=3,
              label="predicted without curvature (one model for all)")
    axes.plot(part["time [s]"], part["with curvature [kPa]"], ".", color=style.BLUE, markersize=3,
              label="predicted with curvature (one model for each curvature)")
    axes.plot(part["time [s]"], part["reference [kPa]"], "-", color=style.BLACK, label="chamber")
    axes.set(xlabel="time [s]", ylabel="pressure [kPa gauge]", title=f"radius {radius(curvature)}")
    axes.legend(loc="upper right")
    axes.set_ylim(top=1.35 * max(part["reference [kPa]"]))
    return style.save(drawing, stem, part)


def draw_bandwidths(stem, table, chosen):
    drawing, axes = style.figure(style.PAGE, 2.8)
    grid = table["bandwidth [deviations]"]
    for number, (name, values) in enumerate((n, v) for n, v in table.items() if n.endswith("RMSE [%]")):
        axes.plot(grid, values, ("o-", "s--", "^-", "v--", "D-", "x--", "+:")[number % 7], markersize=3,
                  label=name.replace(" RMSE [%]", ""))
    axes.axvline(chosen, color="0.6", linewidth=0.8)
    axes.annotate("the paper's 2⁻⁷", (chosen, 0), xycoords=("data", "axes fraction"), xytext=(3, 4),
                  textcoords="offset points", color="0.4", fontsize=7)
    axes.set_xscale("log", base=2)
    axes.set_ylim(0, min(10, max(max(v) for n, v in table.items() if n.endswith("%]"))))
    axes.set(xlabel="bandwidth [standard deviations of the readings]", ylabel="RMSE [% of range]")
    axes.legend(ncol=2)
    return style.save(drawing, stem, table)


def draw_bins(stem, split, shown):
    """RMSE by pressure and direction of some methods on all scans."""
    scores = [score for score in split["scores"] if score["id"] in shown]
    names = list(scores[0]["errors_pa"]["bins"])
    drawing, axes = style.figure(style.PAGE, 2.8)
    columns = {"method": [], "pressure [kPa]": [], "direction": [], "RMSE [kPa]": []}
    width = 0.8 / len(scores)
    for number, score in enumerate(scores):
        for direction in ("loading", "unloading"):
            values = [score["errors_pa"]["bins"][name][direction]["rmse"] for name in names]
            places = [i + (number - (len(scores) - 1) / 2) * width for i in range(len(names))]
            heights = [float("nan") if value is None else value / 1e3 for value in values]
            axes.plot(places, heights, linestyle="", marker="^" if direction == "loading" else "v", markersize=5,
                      markerfacecolor=style.COLOURS[number % 7] if direction == "loading" else "none",
                      color=style.COLOURS[number % 7],
                      label=plain_name(score) if direction == "loading" else None)
            for name, height in zip(names, heights):
                columns["method"].append(score["label"])
                columns["pressure [kPa]"].append(name.replace(" kPa", ""))
                columns["direction"].append(direction)
                columns["RMSE [kPa]"].append(height)
    axes.set_xticks(range(len(names)))
    axes.set_xticklabels([name.replace(" kPa", "") for name in names])
    axes.set(xlabel="chamber pressure [kPa gauge]", ylabel="RMSE [kPa]")
    axes.set_ylim(bottom=0)
    axes.legend(ncol=2, title="filled: loading, open: unloading")
    return style.save(drawing, stem, columns)


def draw_splits(stem, splits):
    drawing, axes = style.figure(style.PAGE, 3.4)
    columns = {"split": [], "method": [], "RMSE [kPa]": [], "low [kPa]": [], "high [kPa]": []}
    labels = list(dict.fromkeys(plain_name(score) for split in splits for score in split["scores"]))
    for number, split in enumerate(splits):
        places, heights, errors = [], [], [[], []]
        for score in split["scores"]:
            interval = score["rmse_pa_interval"]
            rmse = score["errors_pa"]["whole"]["all"]["rmse"]
            if rmse is None:
                continue
            low, high = interval["interval_95"] if interval else (rmse, rmse)
            places.append(labels.index(plain_name(score)) + (number - (len(splits) - 1) / 2) * 0.2)
            heights.append(rmse / 1e3)
            errors[0].append(max(0, rmse - low) / 1e3)
            errors[1].append(max(0, high - rmse) / 1e3)
            for name, value in zip(columns, (split["id"], score["id"], rmse / 1e3, low / 1e3, high / 1e3)):
                columns[name].append(value)
        axes.errorbar(places, heights, errors, fmt="o", markersize=4, capsize=2,
                      color=style.COLOURS[number % 7], label=split["id"].replace("_", " "))
    axes.set_xticks(range(len(labels)))
    axes.set_xticklabels([label.replace(" (", "\n(") for label in labels], rotation=35, ha="right")
    axes.set(ylabel="RMSE [kPa]")
    axes.set_ylim(bottom=0)
    axes.legend()
    return style.save(drawing, stem, columns)


def error_points(curve, kind):
    """[(error of the curvature, score)] of one kind, "relative" [%] or "absolute" [1/m], ascending; 0 is in both."""
    other = "absolute" if kind == "relative" else "relative"
    factor = 100 if kind == "relative" else 1
    points = [(factor * score[kind], score) for score in curve["scores"] if score[other] == 0]
    return sorted(points, key=lambda point: point[0])


def curve_name(curve):
    """As plain_name()."""
    name = curve["id"].replace("_", " ")
    return f"{name} ({curve['label']})" if curve["label"].startswith("Method") else name


def alike(curve, other):
    """Whether two schemes have nearly the same errors, so that their lines would hide each other."""
    return all(abs(a["rmse_pa"] - b["rmse_pa"]) < ONE_LINE for a, b in zip(curve["scores"], other["scores"]))


def draw_curvature_errors(stem, curves):
    drawing, pair = style.figure(style.PAGE, 3.2, ncols=2, sharey=True)
    columns = {"method": [], "error of the curvature": [], "unit": [], "RMSE [kPa]": []}
    lines = []  # lists of schemes that share a line
    for curve in curves:
        line = next((line for line in lines if alike(curve, line[0])), None)
        if line is None:
            lines.append([curve])
        else:
            line.append(curve)
    for axes, kind, unit in zip(pair, ("relative", "absolute"), ("%", "1/m")):
        for number, line in enumerate(lines):
            reference = line[0]["id"] in ("baseline", "flat_only")
            points = error_points(line[0], kind)
            axes.plot([error for error, _ in points], [score["rmse_pa"] / 1e3 for _, score in points],
                      "--" if reference else ("o-", "s-", "^-", "v-", "D-", "x-", "+-")[number % 7], markersize=3.5,
                      color=("0.2" if line[0]["id"] == "baseline" else "0.6") if reference else style.COLOURS[number % 6],
                      label="\n".join(curve_name(curve) for curve in line))
        for curve in curves:
            for error, score in error_points(curve, kind):
                for name, value in zip(columns, (curve["id"], error, unit, score["rmse_pa"] / 1e3)):
                    columns[name].append(value)
        axes.set_xlabel(f"error of the curvature [{unit}]")
        axes.set_ylim(bottom=0)
    pair[0].set_ylabel("RMSE [kPa]")
    pair[1].legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    return style.save(drawing, stem, columns)


# --- the report ---------------------------------------------------------------------------------------


def number(value, digits=2):
    return "–" if value is None else f"{value:.{digits}f}"


def spread(value, digits, deviation_digits):
    if value is None or value["mean"] is None:
        return "–"
    return f"{number(value['mean'], digits)} ± {number(value['deviation'], deviation_digits)}"


def kilopascal(value, digits=1):
    return "–" if value is None else f"{round(value / 1e3, digits) + 0.0:.{digits}f}"


def probability(p):
    if p is None:
        return "–"
    return "< 0.001" if p < 0.001 else f"{p:.3f}"


def interval_text(interval, unit=1.0, digits=2):
    if interval is None:
        return "none: valid for these recordings only"
    low, high = interval["interval_95"]
    return (f"{low / unit:.{digits}f} to {high / unit:.{digits}f} "
            f"({interval['method']}, {interval['n']} {interval['unit']}s)")


def score_rows(scores):
    rows = []
    for score in scores:
        paper = score["paper"] or {"r2": None, "rmse_percent": None}
        rows.append([score["label"], spread(score["r2"], 3, 4), spread(paper["r2"], 2, 4),
                     spread(score["rmse_percent"], 2, 2), spread(paper["rmse_percent"], 2, 2),
                     interval_text(score["rmse_percent_interval"]), score["scored"]])
    return rows


def paper_table(comparison):
    return style.table(["", "R²", "paper's R²", "RMSE%", "paper's RMSE%", "95 % interval of our RMSE%", "scored"],
                       score_rows(comparison["scores"]),
                       "Mean ± standard deviation over taxels. Interval: bootstrap over whole units, readings of a model pooled.")


def use_table(scores, caption):
    rows = []
    for score in scores:
        whole = score["errors_pa"]["whole"]
        low, high = whole["all"]["limits_95"]
        rows.append([plain_name(score), kilopascal(whole["all"]["rmse"]), kilopascal(whole["all"]["bias"]),
                     f"{kilopascal(low)} to {kilopascal(high)}", kilopascal(whole["all"]["p95_absolute"]),
                     f"{kilopascal(whole['loading']['rmse'])} / {kilopascal(whole['unloading']['rmse'])}",
                     f"{kilopascal(score['first_cycle_pa']['rmse'])} / {kilopascal(score['later_cycles_pa']['rmse'])}",
                     f"{number(score['worst_rmse_percent'])} % (no. {score['worst_taxel']})",
                     interval_text(score["rmse_pa_interval"], 1e3, 1)])
    return style.table(["", "RMSE [kPa]", "bias [kPa]", "95 % limits [kPa]", "95th percentile of |error| [kPa]",
                        "RMSE loading / unloading [kPa]", "RMSE first / later cycles [kPa]", "worst taxel",
                        "95 % interval of the RMSE [kPa]"], rows, caption)


def bin_table(scores, caption):
    names = list(scores[0]["errors_pa"]["bins"])
    rows = [[plain_name(score)] + [
        f"{kilopascal(score['errors_pa']['bins'][name]['all']['rmse'])} "
        f"({kilopascal(score['errors_pa']['bins'][name]['all']['bias'])})" for name in names] for score in scores]
    return style.table(["RMSE (bias) [kPa]"] + names, rows, caption)


def test_line(test, p):
    freedom = ", ".join(f"{value:g}" for value in test["degrees_of_freedom"])
    symbol = test["symbol"] + (f"({freedom})" if freedom else "")
    return f"{test['test']}: {symbol} = {number(test['statistic'])}, p {probability(p)}, n = {test['n']} taxels"


def tests_of(comparison):
    pieces = []
    published = comparison["as_published_taxels_treated_as_independent"]
    for name, measure in (("R²", "r2"), ("RMSE%", "rmse_percent")):
        rule = published[measure]
        pieces.append(style.paragraph(f"{name}: {test_line(rule['test'], rule['p'])}"))
        if rule["pairs"]:
            rows = [[f"{pair['first']} – {pair['second']}", pair["test"]["test"],
                     f"{pair['test']['symbol']} = {number(pair['test']['statistic'])}",
                     probability(pair["adjusted_p"]), "yes" if pair["differ"] else "not shown"]
                    for pair in rule["pairs"]]
            pieces.append(style.table(["pair", "test", "statistic", "p, Bonferroni", "differ"], rows, f"{name}, pairs"))
    for sentence in comparison["paper"]["statements"]:
        pieces.append(style.paragraph("The paper: " + sentence))
    rows = [[f"{d['first']} – {d['second']}",
             number(d["rmse_percent"]["estimate"] if d["rmse_percent"] else None),
             interval_text(d["rmse_percent"])] for d in comparison["differences_of_rmse_percent"]]
    pieces.append(style.table(["pair", "difference of RMSE%", "95 % interval"], rows,
                              "Interval: bootstrap over whole units of the highest level that has at least five."))
    return pieces


def comparison_section(comparison, pictures):
    return (comparison["title"],
            [paper_table(comparison)] + pictures +
            [use_table(comparison["scores"], "Errors of the same held-out readings [kPa]."),
             "<h3>As published, taxels treated as independent</h3>"] + tests_of(comparison))


def condition_rows(results):
    return [[row["surface"], radius(row["curvature"][0]), number(row["curvature"][0]),
             number(row["curvature"][0] / 100, 3), row["scans"], row["cycles"], row["mounts"]]
            for row in results["conditions"]]


def history_table(history):
    families = ("static", "plays", "memories", "both", "correction_alone")
    rows = [[protocol["protocol"]] + [kilopascal(protocol["rmse"][family], 2) for family in families] for protocol in history["protocols"]]
    return style.table(["RMSE [kPa]", "static", "plays", "memories", "both", "correction alone"], rows,
                       f"{history['choice']} Errors of means over half a second; each protocol was predicted without it.")


def error_text(score):
    """The error of a curvature: "right", "-40 %", "+2 1/m"."""
    if score["absolute"]:
        return f"{score['absolute']:+g} 1/m"
    return f"{100 * score['relative']:+.0f} %" if score["relative"] else "right"


def curvature_error_table(curves, caption, cell):
    rows = [[curve_name(curve)] + [cell(score) for score in curve["scores"]] for curve in curves]
    return style.table(["curvature is"] + [error_text(score) for score in curves[0]["scores"]], rows, caption)


def stated_share(score):
    return number(100 * score["stated_pa"] / score["moved_pa"], 0) if score["moved_pa"] else "–"


def curvature_error_sections(results, pictures):
    curves = results["curvature_errors"]
    if not curves:
        return []
    return [("Error of the map against error of the curvature", [
        style.paragraph("Trained with the right curvatures, told wrong ones. Same held-out readings as in the split five "
                        "sections. A positive error is a curvature that is too large. A share leaves the flat surface as it is."),
        pictures["curvature_errors"],
        curvature_error_table(curves, "RMSE [kPa]", lambda score: kilopascal(score["rmse_pa"])),
        curvature_error_table(curves, "RMSE [% of range], mean over taxels", lambda score: number(score["rmse_percent"])),
        curvature_error_table(curves, "Where the curvature message states a deviation as large as the error: what this adds to "
                              "the map's deviation, in % of the change of the pressures (root mean squares). –: the pressures "
                              "do not change.", stated_share)])]


def beyond_sections(results, pictures):
    if not results["plan"]["beyond_the_paper"]:
        return []
    pieces = [pictures["splits"], pictures["bins"]]
    for split in results["splits"]:
        name = split["id"].replace("_", " ")
        pieces.append(use_table(split["scores"], f"{name}: {split['description']}"))
        pieces.append(bin_table(split["scores"], f"{name}, by chamber pressure"))
        if split["scores"][-1]["id"] == "history":
            pieces += [pictures["history"], history_table(results["history"])]
    if not results["history"]["assessable"]:
        pieces.append(style.paragraph(f"history: {results['history']['choice']}"))
    return [("Beyond the paper: all scans, bandwidth chosen by nested cross-validation, harder splits", pieces)]


def write_report(folder, results, pictures):
    comparisons = {comparison["id"]: comparison for comparison in results["comparisons"]}
    beyond = results["plan"]["beyond_the_paper"]
    sections = [
        (None, ([f"<p class=verdict>{style.html.escape(results['headline']['text'])}</p>"] if beyond else []) +
         [style.paragraph(sentence) for sentence in results["holds_for"] + results["warnings"]] +
         [style.paragraph(PAPER), style.paragraph(NOT_FOR_PATIENTS)]),
        ("Data", [style.table(["surface", "radius", "1/m", "1/cm", "scans", "cycles", "mounts"],
                              condition_rows(results)),
                  style.paragraph(f"{results['scans']} scans of {len(results['taxels'])} taxels."),
                  pictures["response"], pictures["response_low"], pictures["all_curvatures"]]),
        comparison_section(comparisons["algorithms"], [pictures["algorithms"]]),
        comparison_section(comparisons["flat_against_all"], []),
        comparison_section(comparisons["methods"], [pictures["methods"], pictures["prediction"]]),
        *([comparison_section(comparisons["one_hot"], [])] if "one_hot" in comparisons else []),
        *([("Numbers of the paper that cannot be reproduced",
            [style.paragraph(text) for text in results["unmatchable"]])] if results["unmatchable"] else []),
        ("Bandwidth", [pictures["bandwidths"]]),
        *beyond_sections(results, pictures),
        *curvature_error_sections(results, pictures),
        ("Choices that the paper leaves open", [style.table(
            ["", "the paper", "this study"],
            [[row["subject"], row["paper"], row["study"]] for row in results["decisions"]])]),
        ("Provenance", [style.table(["bag", "scans", "SHA-256"], [
            [bag["name"], bag["scans"], bag["sha256"]] for bag in results["provenance"]["bags"]]),
            style.paragraph(f"fsr_pressure_map {results['provenance']['tool_version']}, "
                            f"{results['provenance']['date']}, seed {results['provenance']['seed']}.")]),
    ]
    style.page(os.path.join(folder, "report.html"), "The paper's study, repeated", sections)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", metavar="FOLDER")
    folder = parser.parse_args().folder
    with open(os.path.join(folder, "results.json"), encoding="utf-8") as source:
        results = json.load(source)
    comparisons = {comparison["id"]: comparison for comparison in results["comparisons"]}
    drawn = curves(read_table(folder, "response.csv"))
    taxel = results["figure_taxel"]
    pair = drawn[:2]

    def stem(name):
        return os.path.join(folder, "figures", name)

    bent = radius(pair[-1][0])
    prediction = read_table(folder, "prediction.csv")
    algorithms = comparisons["algorithms"]["scores"]
    methods = comparisons["methods"]["scores"]
    low = 0.1 * max(max(pressures) for _, _, pressures, _ in drawn)
    pictures = {
        "response": (draw_response(stem("fig5_response"), pair),
                     f"Taxel {taxel} flat and on a radius of {bent} (the paper's Fig. 5)."),
        "response_low": (draw_response(stem("fig8_low_pressure"), pair, low),
                         "The same at low pressure: bending changes the reading at rest (Fig. 8)."),
        "all_curvatures": (draw_response(stem("fig10_all_curvatures"), drawn, width=style.PAGE, height=3.4),
                           f"Taxel {taxel} on all surfaces (Fig. 10)."),
        "algorithms": (draw_boxes(stem("fig6_algorithms"), algorithms,
                                  [PAPER_ALGORITHM[score["id"]] for score in algorithms], stacked=False),
                       "Algorithms on the baseline, one point for each taxel (Fig. 6)."),
        "methods": (draw_boxes(stem("fig7_methods"), methods,
                               [score["label"].replace("Method ", "M") for score in methods], stacked=True),
                    "Methods, one point for each taxel (Fig. 7)."),
        "prediction": (draw_prediction(stem("fig9_prediction"), prediction, pair[-1][0]),
                       f"Held-out predictions of taxel {taxel}, without and with curvature (Fig. 9)."),
        "bandwidths": (draw_bandwidths(stem("bandwidths"), read_table(folder, "bandwidths.csv"),
                                       results["plan"]["bandwidth"]),
                       "RMSE% over the bandwidth, on the same data as the tables."),
    }
    if results["plan"]["beyond_the_paper"]:
        pictures["bins"] = (draw_bins(stem("errors_by_pressure"), results["splits"][0], SHOWN_BY_PRESSURE),
                            "All scans, five sections: RMSE by chamber pressure and direction.")
        for split in results["splits"]:
            if split["scores"][-1]["id"] == "history":
                pictures["history"] = (draw_bins(stem("history_by_pressure"), split, ("per_curvature", "history")),
                                       "Other protocols than trained: RMSE of the static answer and with the sheet's memory.")
        pictures["splits"] = (draw_splits(stem("splits"), results["splits"]),
                              "All scans: RMSE by how the held-out readings were chosen; bars: 95 % intervals.")
    if results["curvature_errors"]:
        pictures["curvature_errors"] = (draw_curvature_errors(stem("curvature_errors"), results["curvature_errors"]),
                                        "RMSE by the error of the curvature that each scheme was told; dashed: schemes that "
                                        f"take no curvature. Schemes that differ by less than {ONE_LINE / 1e3} kPa share a line.")
    write_report(folder, results, {name: style.picture(*made) for name, made in pictures.items()})


if __name__ == "__main__":
    main()
