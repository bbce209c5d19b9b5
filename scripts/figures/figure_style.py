"""Style of the package's figures and reports, and functions that save them.

The scripts beside this one draw results that the tools wrote (CSV, JSON). They compute no results of their own.
"""

import base64
import csv
import html
import os
import re

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

COLUMN = 3.5  # width of one journal column [inch]
PAGE = 7.16  # width of two columns [inch]

# Okabe and Ito's colours, which colour-blind readers can distinguish (https://jfly.uni-koeln.de/color/).
BLUE, ORANGE, GREEN, RED, PURPLE, SKY, YELLOW, BLACK = (
    "#0072B2", "#E69F00", "#009E73", "#D55E00", "#CC79A7", "#56B4E9", "#F0E442", "#000000")
COLOURS = (BLUE, RED, GREEN, ORANGE, PURPLE, SKY, BLACK)

plt.rcParams.update({
    "font.size": 8, "axes.titlesize": 8, "axes.labelsize": 8, "xtick.labelsize": 7, "ytick.labelsize": 7,
    "legend.fontsize": 7, "legend.frameon": False, "lines.linewidth": 1.0, "axes.spines.top": False,
    "axes.spines.right": False, "axes.prop_cycle": matplotlib.cycler(color=COLOURS), "savefig.dpi": 200,
    "figure.constrained_layout.use": True, "pdf.fonttype": 42, "svg.hashsalt": "fsr_pressure_map",
})


def figure(width=COLUMN, height=2.4, **subplots):
    """(figure, axes) of this size [inch]; further arguments go to plt.subplots."""
    return plt.subplots(figsize=(width, height), **subplots)


def save(drawing, stem, columns=None):
    """Writes STEM.png, STEM.pdf and, if {heading: values} is given, STEM.csv with the numbers drawn."""
    os.makedirs(os.path.dirname(os.path.abspath(stem)), exist_ok=True)
    for ending in ("png", "pdf"):
        # Without a date, so that the same results give the same bytes.
        drawing.savefig(f"{stem}.{ending}", metadata={"CreationDate": None} if ending == "pdf" else {"Software": None})
    plt.close(drawing)
    if columns is not None:
        write_csv(f"{stem}.csv", columns)
    return f"{stem}.png"


def write_csv(path, columns):
    """Writes {heading: values} of equal length. A heading contains its unit, e.g. "pressure [kPa]"."""
    lengths = {name: len(values) for name, values in columns.items()}
    if len(set(lengths.values())) > 1:
        raise ValueError(f"{path}: columns of different length: {lengths}")
    with open(path, "w", newline="", encoding="utf-8") as out:
        writer = csv.writer(out)
        writer.writerow(columns)
        writer.writerows(zip(*columns.values()))


def picture(path, caption):
    """A figure for page() that contains the image."""
    with open(path, "rb") as image:
        data = base64.b64encode(image.read()).decode("ascii")
    text = html.escape(caption)
    return (f'<figure><img alt="{text}" src="data:image/png;base64,{data}">'
            f"<figcaption>{text}</figcaption></figure>")


def table(headings, rows, caption=""):
    """An HTML table. A cell is text or a number; numbers are right-aligned."""
    def cell(value):
        number = isinstance(value, (int, float)) and not isinstance(value, bool)
        text = f"{value:.4g}" if isinstance(value, float) else str(value)
        return f'<td{" class=number" if number else ""}>{html.escape(text)}</td>'
    head = "".join(f"<th>{html.escape(str(name))}</th>" for name in headings)
    body = "".join("<tr>" + "".join(map(cell, row)) + "</tr>\n" for row in rows)
    title = f"<caption>{html.escape(caption)}</caption>" if caption else ""
    return f"<table>{title}<thead><tr>{head}</tr></thead>\n<tbody>{body}</tbody></table>"


def paragraph(text):
    return f"<p>{html.escape(text)}</p>"


def printable(text):
    """The text without the control characters that names of bags and surfaces may hold, as settings/text.h has it."""
    return re.sub(r"[\x00-\x08\x0b-\x1f\x7f-\x9f]", "?", text)


_PAGE_STYLE = """
body { font: 15px/1.45 sans-serif; color: #222; max-width: 62em; margin: 2em auto; padding: 0 1em; }
h1 { font-size: 1.5em; } h2 { font-size: 1.2em; margin-top: 2em; border-bottom: 1px solid #ccc; }
table { border-collapse: collapse; margin: 1em 0; font-size: 0.9em; } caption { text-align: left; color: #555; }
th, td { padding: 0.2em 0.7em; border-bottom: 1px solid #ddd; text-align: left; } .number { text-align: right; }
figure { margin: 1em 0; } img { max-width: 100%; } figcaption { color: #555; font-size: 0.9em; }
.verdict { font-size: 1.25em; background: #f1f5f9; border-left: 4px solid #0072B2; padding: 0.6em 1em; }
"""


def page(path, title, sections):
    """Writes one HTML file that needs no network; `sections` is [(heading or None, [html, ...])]."""
    parts = [f"<!DOCTYPE html>\n<html lang=en><head><meta charset=utf-8><title>{html.escape(title)}</title>"
             f"<style>{_PAGE_STYLE}</style></head><body><h1>{html.escape(title)}</h1>"]
    for heading, pieces in sections:
        if heading:
            parts.append(f"<h2>{html.escape(heading)}</h2>")
        parts.extend(pieces)
    parts.append("</body></html>\n")
    unfinished = path + ".part"
    with open(unfinished, "w", encoding="utf-8") as out:
        out.write(printable("\n".join(parts)))
    os.replace(unfinished, path)
