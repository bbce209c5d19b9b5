#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "discrepancy/samples/measured.h"
#include "discrepancy/samples/taxel_courses.h"
#include "fsr_pressure_map/simulation/simulation_settings.h"

namespace fsr::discrepancy {

/// Taxels or a line that fail, found by a detector.
struct Fault {
  simulation::Detector detector = simulation::Detector::kNone;
  std::string id;                                ///< id of the effect that this detector finds
  std::size_t line = 0;                          ///< index of the row or column, if a line fails
  std::vector<std::size_t> taxels;               ///< row-major
  double share = 0;                              ///< share of the scans that are faulty
  double depth = 0;                              ///< mean relative loss of the reading
  double longest = 0;                            ///< longest spell [s]
  std::vector<std::pair<double, double>> times;  ///< start and end of each spell, since the first scan [s]
  double p = 1;                                  ///< of its test, corrected for all taxels or lines
  double at_map = 0;  ///< rms error of the pressure at its taxels, over all scans [Pa]

  bool isLine() const {
    return detector == simulation::Detector::kRowFaults || detector == simulation::Detector::kColumnFaults;
  }
};

/// Errors that all faults cause in the readings, relative to the values expected from the other taxels.
struct FaultyReadings {
  double square = 0;    ///< squared errors, summed over scans and taxels [share of full scale, squared]
  double held_out = 0;  ///< the same over the hold-out cycles
  double readings = 0;  ///< scans x taxels
  double held_out_readings = 0;
  Interval pressure;                    ///< range in which the errors show [Pa]
  std::vector<std::string> conditions;  ///< surfaces on which they show; empty = all
};

struct Faults {
  std::vector<Fault> faults;  ///< at most one of each id
  FaultyReadings readings;
};

/// Least size at the map that matters [Pa]: `least_gap`, or its share of the range of the chamber's pressure.
double leastGap(const Measured& measured, const DiscrepancyOptions& options);

/// Is called with the share of the search that is done.
using FaultProgress = std::function<void(double share)>;

/// Searches every scan for faults, in the readings relative to those of the other taxels (taxelCourses()).
/// What changes all taxels alike is therefore no fault of any.
///
/// A line fails where its taxels leave the neighbouring lines together from one scan to the next. The largest
/// such step over all lines is held against the largest one after the taxels were permuted over the sheet
/// (P. Westfall, S. Young, Resampling-based multiple testing, Wiley 1993).
///
/// A taxel fails where its largest deviation is an outlier among those of all taxels. Their logarithms follow
/// Gumbel's distribution (E. Gumbel, Statistics of extremes, 1958), whose parameters are the median and the
/// quartiles over the taxels. A failing taxel is named only where its readings do not follow the others: it
/// is dead where it goes to the reading without load, and stuck where it goes to another one.
///
/// Both need `level`, and a size at the map of at least leastGap().
Faults findFaults(const Measured& measured, const DiscrepancyOptions& options,
                  const FaultProgress& progress = {});

/// The effect and the parameter values with which a simulation shows the fault.
simulation::EnabledEffect asEffect(const Fault& fault);

}  // namespace fsr::discrepancy
