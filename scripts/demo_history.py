"""The demo's picture: error of the live maps against the time since the chamber changed its direction."""
import pathlib
import sys

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "figures"))
import figure_style as style  # noqa: E402

# Name, label, colour, line, and whether only readings are drawn for which history is settled.
LINES = (("interpolated", "static", style.RED, "-", False), ("history", "history", style.BLUE, "-", False),
         ("history", "history, once settled", style.BLUE, ":", True), ("floor", "floor", "0.5", "-", False))
DIRECTIONS = {1: ("loading, then held", "loading"), -1: ("unloading, then at rest", "unloading")}
RATE_WINDOW = 1.0  # over which the rate of pressure is found [s]
STILL = 0.1  # share of the fastest rate below which the chamber holds its pressure
BIN = 1.0  # [s]
FEWEST = 20  # readings of a bin


def rates(stamps, pressures):
    """Rate of a pressure at its stamps [ns], as the difference over a window around each [Pa/s]."""
    half = RATE_WINDOW / 2 * 1e9
    first, last = stamps - half, stamps + half
    change = numpy.interp(last, stamps, pressures) - numpy.interp(first, stamps, pressures)
    return change / (numpy.minimum(last, stamps[-1]) - numpy.maximum(first, stamps[0])) * 1e9


def since_reversal(reference):
    """For each sample of the reference: the direction in which the chamber went last (1 = loading, -1, 0 = not known), the time
    since it took it [s], and whether it moves."""
    stamps, pressures = reference.T
    rate = rates(stamps, pressures)
    moves = numpy.abs(rate) > STILL * numpy.abs(rate).max()
    direction, since = numpy.zeros(len(stamps)), numpy.full(len(stamps), numpy.nan)
    now, turned = 0, numpy.nan
    for i, stamp in enumerate(stamps):
        if moves[i] and numpy.sign(rate[i]) != now:
            now, turned = numpy.sign(rate[i]), stamp
        direction[i], since[i] = now, (stamp - turned) / 1e9
    return direction, since, moves


def error_by_time(runs, name, direction, settled_only=False):
    """Of one map after all reversals of one direction: middles of the bins [s] and RMSE [kPa], over the taxels and runs."""
    times, squares = [], []
    for run in runs:
        at = numpy.searchsorted(run.reference[:, 0], run.common_stamps()).clip(0, len(run.reference) - 1)
        directions, since, _ = since_reversal(run.reference)
        square = run.errors(name)**2
        chosen = (directions[at] == direction)[:, None] & numpy.isfinite(square)
        if settled_only:
            chosen &= run.common_settled()
        times.append(numpy.broadcast_to(since[at][:, None], square.shape)[chosen])
        squares.append(square[chosen])
    bins = (numpy.concatenate(times) / BIN).astype(int)
    count = numpy.bincount(bins)
    total = numpy.bincount(bins, numpy.concatenate(squares))
    full = numpy.flatnonzero(count >= FEWEST)
    return (full + 0.5) * BIN, numpy.sqrt(total[full] / count[full]) / 1e3


def length_of_ramp(run, direction):
    """Median time from a reversal to the end of its ramp [s]."""
    directions, since, moves = since_reversal(run.reference)
    chosen = moves & (directions == direction)
    begins = numpy.flatnonzero(chosen & (since == 0))
    ends = [since[part][chosen[part]].max() for part in numpy.split(numpy.arange(len(since)), begins)[1:]]
    return float(numpy.median(ends))


def draw(runs, stem):
    """Draws the errors of the runs and returns the path of the picture. The numbers are in STEM.csv."""
    figure, both = style.figure(style.PAGE, 2.6, ncols=2, sharey=True)
    rows = []
    for axes, (direction, (title, word)) in zip(both, DIRECTIONS.items()):
        for name, label, colour, line, settled_only in LINES:
            if settled_only and all(run.common_settled().all() for run in runs):
                continue  # the line above is the same
            times, errors = error_by_time(runs, name, direction, settled_only)
            axes.plot(times, errors, line, color=colour, label=label, linewidth=1.5)
            rows += [(word, label, time, error) for time, error in zip(times, errors)]
        held = length_of_ramp(runs[0], direction)
        end = times[-1] + BIN / 2
        axes.axvspan(held, end, color="0.94", zorder=0)
        axes.text(held, 0.98, " pressure held" if direction > 0 else " at rest", transform=axes.get_xaxis_transform(), va="top", fontsize=7)
        axes.set(title=title, xlabel="time since the last reversal [s]", xlim=(0, end))
    both[0].set_ylabel("RMSE of the live map [kPa]")
    both[1].set_ylim(0, 1.4 * max(row[3] for row in rows))  # of both; room for the legend
    both[1].legend(loc="upper left")
    columns = dict(zip(("direction", "map", "time since the last reversal [s]", "RMSE [kPa]"), map(list, zip(*rows))))
    return style.save(figure, str(stem), columns)
