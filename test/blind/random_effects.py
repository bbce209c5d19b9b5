"""Statistics of a random effect, measured and simulated: what no simulation repeats scan by scan, but on the whole.

Both are what the bags differ from the simulation without the effect (base.yaml, driven through them, without white noise), on the
taxels that the verdict names, over all scans.
"""

import numpy

import recompute

LOST = 0.15  # of the reading: a line that reads so much less has lost contact (ratio)
LEAST = 0.05  # of full scale; below it a line is not loaded enough to tell (ratio)
MEANS = 20  # scans whose mean stands for the slow part of a residual


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


def compare(command, bags, taxels, effect, found, work, environment):
    """{name: (measured, simulated)}."""
    runs = recompute.runs_in_time_order([recompute.Scans(bag) for bag in bags])
    measured = [bag for run in runs for bag in run]
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
