"""Statistics of a random effect, measured and simulated: what no simulation repeats scan by scan, but on the whole.

Both are what the bags differ from the simulation without the effect (base.yaml, driven through them, without white noise), on the
taxels that the verdict names, over all scans.
"""

import re

import numpy

import recompute

LOST = 0.15  # of the reading: a line that reads so much less has lost contact (ratio)
LEAST = 0.05  # of full scale; below it a line is not loaded enough to tell (ratio)
MEANS = 20  # scans whose mean stands for the slow part of a residual
WALK = "walk"  # what compare() is asked for where an effect is a random walk
SEEDS = (11, 12, 13, 14, 15)  # of the walks that are simulated: one has too few steps for its rms
LOADED = 0.2  # of the range of the mean reading: above it no taxel is at the lower end of its range, so that a zero shows (ratio)


def driven(command, simulation, runs, work, environment):
    """Simulated scans of every bag, in order of time."""
    scans = []
    for number, run in enumerate(runs):
        scans += recompute.drive(command, simulation, run, work / ("%s_%d" % (simulation.stem, number)), environment)
    return scans


def slow_part(values):
    kernel = numpy.ones(MEANS) / MEANS
    return numpy.apply_along_axis(lambda column: numpy.convolve(column, kernel, "same"), 0, values)


def lost_share(residual, base, full_scale):
    """Share of the loaded scans in which the mean of the line's taxels is far below the simulation without the effect."""
    line, clean = residual.mean(axis=1), base.mean(axis=1)
    loaded = clean > LEAST * full_scale
    return float((line[loaded] < -LOST * clean[loaded]).mean()) if loaded.any() else float("nan")


def spectral_peak(residual, rate):
    """Frequency of the strongest line, mean spectrum over the taxels, without what is slower than a twentieth of the rate [Hz]."""
    window = numpy.hanning(len(residual))[:, None]
    power = (numpy.abs(numpy.fft.rfft(residual * window, axis=0))**2).mean(axis=1)
    frequency = numpy.fft.rfftfreq(len(residual), 1 / rate)
    power[frequency < rate / 20] = 0
    return float(frequency[power.argmax()])


def between_mounts(residuals):
    """Rms over bags and taxels of the mean residual of each bag: what differs from mount to mount [counts]."""
    return float(numpy.sqrt(numpy.mean([(r.mean(axis=0))**2 for r in residuals])))


def cycles_of(clean):
    """First and last scan of each stretch in which the mean reading is well above rest."""
    least = clean.min() + LOADED * numpy.ptp(clean)
    loaded = numpy.concatenate([[False], clean > least, [False]])
    return numpy.flatnonzero(numpy.diff(loaded.astype(int))).reshape(-1, 2)


def rms_step(residuals, base, chosen):
    """Rms of the step that the mean over the taxels takes from one loaded cycle to the next, as that of a walk in a minute [counts]."""
    times, means = [], []
    for residual, without in zip(residuals, base):
        for first, last in cycles_of(without.counts[:, chosen].mean(axis=1)):
            times.append(without.stamps[first:last].mean() / 60e9)
            means.append(residual[first:last].mean())
    order = numpy.argsort(times)
    steps = numpy.diff(numpy.array(means)[order]) / numpy.sqrt(numpy.diff(numpy.array(times)[order]))
    return float(numpy.sqrt((steps**2).mean())) if steps.size else float("nan")


def with_seed(simulation, seed):
    text = simulation.read_text()
    simulation.write_text(re.sub(r"^seed: .*$", "seed: %d" % seed, text, flags=re.MULTILINE))
    return simulation


def compare_walk(command, runs, chosen, found, work, environment):
    """(measured, simulated): rms_step() of the bags, and the rms of it over simulations with other random numbers."""
    both = [], []
    for seed in SEEDS:
        folder = work / str(seed)
        base, added = [driven(command, with_seed(recompute.quiet_copy(found / name, folder / "rig"), seed), runs, folder, environment)
                       for name in ("base.yaml", "simulation.yaml")]
        for scans, result in zip(([bag for run in runs for bag in run], added), both):
            residuals = [scan.counts[:, chosen] - without.counts[:, chosen] for scan, without in zip(scans, base)]
            result.append(rms_step(residuals, base, chosen))
    return tuple(float(numpy.sqrt(numpy.mean(numpy.square(steps)))) for steps in both)


def compare(command, bags, taxels, effect, found, work, environment):
    """{name: (measured, simulated)}."""
    runs = recompute.runs_in_time_order([recompute.Scans(bag) for bag in bags])
    measured = [bag for run in runs for bag in run]
    if effect == WALK:
        chosen = list(taxels) or list(range(measured[0].counts.shape[1]))
        return {"step in a minute [counts]": compare_walk(command, runs, chosen, found, work, environment)}
    base = driven(command, recompute.quiet_copy(found / "base.yaml", work / "rig"), runs, work, environment)
    added = driven(command, recompute.quiet_copy(found / "simulation.yaml", work / "rig"), runs, work, environment)
    chosen = list(taxels) or list(range(base[0].counts.shape[1]))

    def residuals(scans):
        return [scan.counts[:, chosen] - without.counts[:, chosen] for scan, without in zip(scans, base)]

    both = residuals(measured), residuals(added)
    if effect in ("row_fault", "column_fault"):
        clean, full = numpy.concatenate([b.counts[:, chosen] for b in base]), base[0].full_scale
        return {"share of time without contact": tuple(lost_share(numpy.concatenate(r), clean, full) for r in both)}
    if effect == "mains_pickup":
        longest = max(range(len(measured)), key=lambda i: len(measured[i].stamps))
        stamps = measured[longest].stamps
        rate = 1e9 * (len(stamps) - 1) / (stamps[-1] - stamps[0])
        fast = [r[longest] - slow_part(r[longest]) for r in both]
        return {"rms [counts]": tuple(float(f.std()) for f in fast),
                "spectral peak [Hz]": tuple(spectral_peak(f, rate) for f in fast)}
    return {"rms between mounts [counts]": tuple(between_mounts(r) for r in both)}
