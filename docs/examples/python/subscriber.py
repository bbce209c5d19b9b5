#!/usr/bin/env python3
"""Prints the peak of each pressure map with its standard deviation, and how many taxels have no reading."""
import math

import rospy
from fsr_pressure_map.msg import PressureMap


def on_map(message):
    readings = [i for i, pressure in enumerate(message.pressure) if not math.isnan(pressure)]  # row-major; NaN = no reading
    if message.state != PressureMap.STATE_OK or not readings:
        print("no valid map: state %d" % message.state, flush=True)
        return
    peak = max(readings, key=lambda i: message.pressure[i])
    at_least = ">= " if message.flags[peak] & PressureMap.FLAG_SATURATED else ""
    print("peak %s%.1f +- %.1f kPa at row %d, column %d; %d taxels without a reading"
          % (at_least, message.pressure[peak] / 1000, message.deviation[peak] / 1000, peak // message.columns, peak % message.columns,
             len(message.pressure) - len(readings)), flush=True)


rospy.init_node("peak_printer")
rospy.Subscriber("/fsr/pressure_map", PressureMap, on_map)
rospy.spin()
