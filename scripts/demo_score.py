"""Scores of the demo's live runs against the chamber pressure, and the demo's picture."""
import functools
import subprocess
import time

import numpy
import rosbag

UNDER_PRESSURE = 2e3  # gauge pressure at which the first cycle of a run begins and the last ends [Pa]


def read_run(path, namespace, maps):
    """The reference (stamps [s], gauge pressure [Pa]), and for each scheme (stamps [s], maps [scans x taxels])."""
    reference, ambient = [], 101325.0
    series = {scheme: ([], []) for scheme in maps}
    scheme_of = {f"/{namespace}/{topic}": scheme for scheme, topic in maps.items()}
    with rosbag.Bag(str(path)) as bag:
        for topic, message, _ in bag.read_messages():
            if topic in scheme_of:
                stamps, pressures = series[scheme_of[topic]]
                stamps.append(message.header.stamp.to_sec())
                pressures.append(message.pressure)
            elif topic.endswith("/chamber_pressure"):
                reference.append((message.header.stamp.to_sec(), message.fluid_pressure))
            elif topic.endswith("/matrix_info"):
                ambient = message.ambient_pressure
    reference = numpy.array(sorted(reference))
    reference[:, 1] -= ambient
    return reference, {scheme: tuple(map(numpy.array, values)) for scheme, values in series.items()}


def score(path, namespace, maps):
    """For each scheme: RMSE in % of the run's range and in kPa, and bias [kPa], as means over taxels; number of missing readings
    and of scans. Counts the cycles of the run without the rest before and after. Schemes are compared on scans that all of them
    have a map of, because the recorder may receive the first map of one node later than that of another."""
    reference, series = read_run(path, namespace, maps)
    under = reference[reference[:, 1] > UNDER_PRESSURE, 0]
    common = functools.reduce(numpy.intersect1d, [stamps for stamps, _ in series.values()])
    result = {}
    for scheme, (stamps, pressures) in series.items():
        inside = (stamps >= under[0]) & (stamps <= under[-1]) & numpy.isin(stamps, common)
        truth = numpy.interp(stamps[inside], reference[:, 0], reference[:, 1])[:, None]
        error = pressures[inside] - truth
        rmse = numpy.sqrt(numpy.nanmean(error**2, axis=0))  # of each taxel
        result[scheme] = {
            "rmse_percent": 100 * rmse.mean() / numpy.ptp(truth),
            "rmse_kpa": rmse.mean() / 1e3,
            "bias_kpa": numpy.nanmean(error) / 1e3,
            "missing": int(numpy.isnan(error).sum()),
            "scans": int(inside.sum()),
        }
    return result


def table(scores, trained, unseen):
    lines = ["", "Live error against the chamber's pressure (mean over taxels of the RMSE over new cycles)", "",
             f"{'surface':24s}{'flat-only':>20s}{'one for all':>20s}{'per curvature':>20s}{'interpolated':>20s}{'scans':>8s}",
             " " * 24 + f"{'% of range    kPa':>20s}" * 4]
    for surface in trained + [unseen]:
        name = surface + (" (not trained)" if surface == unseen else "")
        cells = [scores[surface][scheme] for scheme in ("flat_only", "baseline", "per_curvature", "interpolated")]
        lines.append(f"{name:24s}" + "".join(f"{cell['rmse_percent']:12.2f}{cell['rmse_kpa']:8.1f}" for cell in cells)
                     + f"{cells[0]['scans']:8d}")
    return "\n".join(lines) + "\n"


def complaints(scores, trained):
    """Sentences that contradict "knowing the curvature reduces the error"; empty = none."""
    result = []
    for surface in trained:
        rmse = {scheme: values["rmse_percent"] for scheme, values in scores[surface].items()}
        if any(value != value for value in rmse.values()):
            result.append(f"{surface}: a scheme gave no reading")
        elif surface == "flat":
            if rmse["per_curvature"] > rmse["flat_only"] * (1 + 1e-9):
                result.append(f"flat: per-curvature ({rmse['per_curvature']:.2f} %) is worse than flat-only ({rmse['flat_only']:.2f} %)")
        elif rmse["per_curvature"] >= min(rmse["flat_only"], rmse["baseline"]):
            result.append(f"{surface}: per-curvature ({rmse['per_curvature']:.2f} %) does not have a smaller error than flat-only "
                          "and one-for-all")
    return result


def screenshot(rig, picture, environment, pressure, limit):
    """Starts cycles and takes a picture of rviz when the gauge pressure is above `pressure` [Pa] and the sheet is drawn. Returns
    False if this did not happen within `limit` [s]."""
    from sensor_msgs.msg import FluidPressure
    latest = {"pressure": 0.0}
    subscriber = rig.rospy.Subscriber("/fsr/chamber_pressure", FluidPressure,
                                      lambda message: latest.update(pressure=message.fluid_pressure - 101325.0))
    rig.rospy.set_param("/fsr/rig_emulator/chamber/cycles", 1000)
    rig.call_start()
    give_up = time.monotonic() + limit
    taken = False
    while not taken and time.monotonic() < give_up:
        if latest["pressure"] > pressure:
            subprocess.run(["import", "-window", "root", str(picture)], env=environment, check=True)
            coloured = subprocess.check_output(  # share of the scene below the legend that is coloured
                ["convert", str(picture), "-crop", "600x400+380+340", "-colorspace", "HSL", "-channel", "G", "-separate",
                 "+channel", "-threshold", "25%", "-format", "%[fx:mean]", "info:"], text=True)
            taken = float(coloured) > 0.1  # 0.2 to 0.3 with the sheet, 0.002 with only the axes
        else:
            time.sleep(0.01)
    subscriber.unregister()
    return taken
