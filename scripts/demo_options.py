#!/usr/bin/python3
"""Records, trains and compares on an emulated rig.

1. Mounts the sheet twice on each surface and records it at rest, before its first load. Then records one bag for each
   surface of the paper (C. Ahmadizadeh, C. Menon, Sensors 2019, 19(24), 5519, https://doi.org/10.3390/s19245519): chamber
   cycles of the emulated rig through the real serial driver, slow ones, fast ones with long dwells, and partial ones.
2. Trains four calibrations from these bags: flat-only, one for all (baseline), per curvature, and interpolated; and a
   fifth, interpolated with a model of the sheet's memory (history).
3. Runs five live calibration nodes on cycles of another pace and dwell, on each surface and on one that was not used for
   training, and prints their errors against the chamber's pressure. Beside them stands the floor: the errors of a static
   map on the same rig without loop and creep. It draws the errors against the time since the last reversal.
4. Shows the pressure map in rviz and saves a picture: on the display, until the window is closed, or without a display on a
   virtual one.
5. Mounts a sheet that was not loaded yet on a cylinder of 5 cm and tells calibrated.launch 9 cm. Asks the calibration node
   whether the sheet agrees (~check_surface), uses what the sheet tells instead (~estimate_surface), and prints the errors of
   the map of one run with the wrong, the estimated and the true surface.
6. Hides an effect in measurements made with formulas from outside the package, asks `discrepancy` what is missing, and
   prints its answer beside the key.

With --day, instead: writes a plan for 45 min of rig time. An emulated operator follows the conductor
through it. What the conductor says is printed. Once the plan is done, the conductor has the report of
the day written by itself.

The exit status is 0 only if per-curvature has a smaller error than flat-only and one-for-all on every bent surface of the
training, and is no worse than flat-only on the flat one, if history is nowhere worse than interpolated by more than 1 %,
and if the wrong surface is found and costs more than the estimated one.
"""
import argparse


def read():
    parser = argparse.ArgumentParser(prog="scripts/demo", description=__doc__, allow_abbrev=False,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--output", default="demo_output", help="folder for bags, calibrations and the screenshot (%(default)s)")
    parser.add_argument("--time-scale", type=float, default=30.0, help="rig seconds in a second (%(default)s)")
    parser.add_argument("--cycles", type=int, default=3, help="chamber cycles of each of the three training protocols (%(default)s)")
    parser.add_argument("--live-cycles", type=int, default=2, help="chamber cycles of each live run (%(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="seed of the emulated rig (%(default)s)")
    parser.add_argument("--no-rviz", action="store_true", help="do not open rviz and take no picture")
    parser.add_argument("--day", action="store_true", help="a conducted day with an operator, instead of the above")
    return parser.parse_args()


if __name__ == "__main__":
    read()
