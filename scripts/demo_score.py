"""Scores of the demo's live runs against the chamber pressure, and the demo's picture."""
import dataclasses
import functools
import subprocess
import time

import numpy

UNDER_PRESSURE = 2e3  # gauge pressure at which the first cycle of a run begins and the last ends [Pa]
HISTORY_SHORT = 4096  # flag of a reading whose deviation is more than twice the settled one
WORSE = 1.01  # history may be worse than the static answer by this factor on no surface that was trained
COLUMNS = {"flat_only": "flat-only", "baseline": "one for all", "per_curvature": "per curvature", "interpolated": "interpolated",
           "history": "history", "floor": "floor"}


@dataclasses.dataclass
class Run:
    """A live run. Stamps are in ns."""
    reference: numpy.ndarray  # [samples x 2], stamp and gauge pressure [Pa]
    series: dict  # of each map: stamps and pressures [scans x taxels] [Pa]
    settled: numpy.ndarray  # [scans of history x taxels], readings without the flag HISTORY_SHORT

    def truth(self, stamps):
        return numpy.interp(stamps, self.reference[:, 0], self.reference[:, 1])

    def under_pressure(self, stamps):
        """Which stamps lie in the cycles, without the rest before and after."""
        under = self.reference[self.reference[:, 1] > UNDER_PRESSURE, 0]
        return (stamps >= under[0]) & (stamps <= under[-1])

    def common_stamps(self):
        """Of the cycles, the scans that every map has. The recorder may receive the first map of one node later than that of
        another."""
        common = functools.reduce(numpy.intersect1d, [stamps for stamps, _ in self.series.values()])
        return common[self.under_pressure(common)]

    def common_settled(self):
        """Of the common scans, [scans x taxels]."""
        return self.settled[numpy.isin(self.series["history"][0], self.common_stamps())]

    def errors(self, name):
        """Of a map in the common scans [Pa], [scans x taxels]."""
        common = self.common_stamps()
        stamps, pressures = self.series[name]
        return pressures[numpy.isin(stamps, common)] - self.truth(common)[:, None]


def read_run(path, namespace, maps):
    """`maps`: topic of each map."""
    import rosbag
    reference, ambient = [], 101325.0
    read = {name: ([], [], []) for name in maps}
    name_of = {f"/{namespace}/{topic}": name for name, topic in maps.items()}
    with rosbag.Bag(str(path)) as bag:
        for topic, message, _ in bag.read_messages():
            if topic in name_of:
                stamps, pressures, flags = read[name_of[topic]]
                stamps.append(message.header.stamp.to_nsec())
                pressures.append(message.pressure)
                flags.append(message.flags)
            elif topic.endswith("/chamber_pressure"):
                reference.append((message.header.stamp.to_nsec(), message.fluid_pressure))
            elif topic.endswith("/matrix_info"):
                ambient = message.ambient_pressure
    reference = numpy.array(sorted(reference))
    reference[:, 1] -= ambient
    series = {name: (numpy.array(stamps), numpy.array(pressures)) for name, (stamps, pressures, _) in read.items()}
    return Run(reference, series, numpy.array(read["history"][2]) & HISTORY_SHORT == 0)


def score(run):
    """For each map: RMSE in % of the run's range and in kPa, and bias [kPa], as means over taxels; the same RMSE in kPa of the
    readings for which history is settled; number of missing readings and of scans, share of readings that are not settled.
    Counts the cycles of the run without the rest before and after."""
    settled = run.common_settled()
    result = {}
    for name in run.series:
        error = run.errors(name)
        rmse = numpy.sqrt(numpy.nanmean(error**2, axis=0))  # of each taxel
        result[name] = {
            "rmse_percent": 100 * rmse.mean() / numpy.ptp(run.truth(run.common_stamps())),
            "rmse_kpa": rmse.mean() / 1e3,
            "settled_kpa": numpy.sqrt(numpy.nanmean(error[settled]**2)) / 1e3 if settled.any() else float("nan"),
            "bias_kpa": numpy.nanmean(error) / 1e3,
            "missing": int(numpy.isnan(error).sum()),
            "scans": len(error),
            "unsettled": float(1 - settled.mean()),
        }
    return result


def settled_line(scores, trained):
    static, history, floor = (numpy.mean([scores[surface][name]["settled_kpa"] for surface in trained])
                              for name in ("interpolated", "history", "floor"))
    return (f"Settled readings alone, mean over the surfaces of training: interpolated {static:.1f} kPa, history {history:.1f} kPa, "
            f"floor {floor:.1f} kPa.")


def table(scores, trained, unseen):
    width = 16
    lines = ["", "Live error against the chamber's pressure: mean over taxels of the RMSE over cycles of a pace and dwell that took no part in training.",
             "interpolated is the static answer, history the same with the sheet's memory; floor: a static map on the same rig without loop and creep.",
             "not settled: readings with the flag HISTORY_SHORT; they count.", "",
             f"{'surface':26s}" + "".join(f"{title:>{width}s}" for title in COLUMNS.values()) + f"{'not settled':>13s}{'scans':>7s}",
             " " * 26 + f"{'% of range  kPa':>{width}s}" * len(COLUMNS)]
    for surface in trained + [unseen]:
        name = surface + (" (not trained)" if surface == unseen else "")
        cells = [scores[surface][column] for column in COLUMNS]
        lines.append(f"{name:26s}" + "".join(f"{cell['rmse_percent']:9.2f}{cell['rmse_kpa']:7.1f}" for cell in cells)
                     + f"{100 * cells[0]['unsettled']:11.1f} %{cells[0]['scans']:7d}")
    return "\n".join([*lines, "", settled_line(scores, trained)]) + "\n"


def complaints(scores, trained):
    """Sentences that contradict "knowing the curvature, and the sheet's memory, reduces the error"; empty = none."""
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
        if rmse["history"] > WORSE * rmse["interpolated"]:
            result.append(f"{surface}: history ({rmse['history']:.2f} %) is worse than the static answer ({rmse['interpolated']:.2f} %)")
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
            coloured = subprocess.check_output(  # share of the scene beside the legend that is coloured
                ["convert", str(picture), "-crop", "385x660+582+70", "-colorspace", "HSL", "-channel", "G", "-separate",
                 "+channel", "-threshold", "25%", "-format", "%[fx:mean]", "info:"], text=True)
            taken = float(coloured) > 0.1  # 0.2 with the sheet; the axes alone are thin lines
        else:
            time.sleep(0.01)
    subscriber.unregister()
    return taken
