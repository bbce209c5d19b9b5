#!/usr/bin/python3
"""insole_gap.py VERDICT.yaml...: gap of a plain smoothing spline on the hold-out scans of verdicts on the insole's two bags.

docs/cases.md says how the bags are made. Each taxel gets one spline of the pressure (scipy.interpolate.make_smoothing_spline, weight by
generalised cross-validation) fitted to all scans but the held-out cycle. Prints file, stated gap, gap of the splines, as shares of full
scale. Needs SciPy 1.10. The numbers stand in test/discrepancy/measured_data_test.cpp.
"""

import csv
import gzip
import pathlib
import sys

import numpy
import yaml
from scipy.interpolate import make_smoothing_spline

MEASURED = pathlib.Path(__file__).resolve().parent / "measured"
TABLES = (("belli_staircase.csv.gz", 946684800), ("belli_four_cycles.csv.gz", 946688400))
TAXELS = "001 004 008 011 014 017 021 024 027 030 034 037 040 045 051 054 057 060 064 067 070 073 077 080".split()


def readings():
    """Stamps [s], pressures [kPa], readings [share of full scale, scans x taxels] of both sessions."""
    parts = []
    for table, start in TABLES:
        with gzip.open(MEASURED / table, "rt") as file:
            rows = list(csv.DictReader(file))
        time = numpy.array([float(row["time_s"]) for row in rows]) + start
        pressure = numpy.array([float(row["pressure_aligned_kPa"]) for row in rows])
        counts = numpy.array([[float(row["c" + taxel]) for taxel in TAXELS] for row in rows])
        parts.append((time, pressure, (255 - counts) / 255))
    return [numpy.concatenate(columns) for columns in zip(*parts)]


def gap(time, pressure, reading, spans):
    """Rms of the hold-out scans less the splines; the whole time between the first and the last span is not fitted."""
    held_out = numpy.zeros(len(time), bool)
    for begin, end in spans:
        held_out |= (time >= begin - 1e-3) & (time <= end + 1e-3)
    fitted = (time < spans[0][0] - 1e-3) | (time > spans[-1][1] + 1e-3)
    at, place = numpy.unique(pressure[fitted], return_inverse=True)
    number = numpy.bincount(place).astype(float)
    square = 0
    for taxel in reading.T:
        spline = make_smoothing_spline(at, numpy.bincount(place, taxel[fitted]) / number, number)
        square += numpy.sum((taxel[held_out] - spline(numpy.clip(pressure[held_out], at[0], at[-1]))) ** 2)
    return numpy.sqrt(square / (held_out.sum() * reading.shape[1]))


def main():
    data = readings()
    for path in sys.argv[1:]:
        verdict = yaml.safe_load(pathlib.Path(path).read_text())
        spans = sorted(tuple(span) for bag in verdict["hold_out"] for span in bag["cycles"])
        print(path, "%.6f %.6f" % (verdict["gap"]["before"], gap(*data, spans)))


main()
