#pragma once

#include <string>
#include <vector>

#include "discrepancy/decide/decision.h"
#include "discrepancy/fit/mount_fields.h"
#include "discrepancy/fit/static_fit.h"
#include "discrepancy/fit/static_misfit.h"
#include "discrepancy/fit/taxel_fit.h"
#include "discrepancy/samples/faults.h"
#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/simulation/simulation_settings.h"

namespace fsr::discrepancy {

/// Mains hum. Its phase advances through the matrix in the order of the scan.
struct Mains {
  bool found = false;
  double share = 0;      ///< share of the readings' squared error
  double p = 1;          ///< of its line among those of permuted taxels
  double at_map = 0;     ///< its rms divided by the mean slope of the static curves [Pa]
  double amplitude = 0;  ///< [share of full scale]
  double turn = 0;       ///< phase from one taxel of the scan to the next [rad]
  double beat = 0;       ///< its apparent frequency after sampling [Hz]
  double rate = 0;       ///< of the samples [Hz]
  Trace cosine, sine;    ///< its time course, to subtract it from the common traces
};

/// Searches for hum. A hum has one phase in each taxel, and the phase advances from taxel to taxel.
/// Therefore one of the patterns exp(j turn i), in the order of the scan, stands out, and its time course
/// turns at one frequency, folded down by the sampling: a narrow line on one side of the spectrum. A pattern
/// that stands still in space has the same power at f and at -f, and is no hum. The largest such line is held
/// against those that the same search finds after the taxels were permuted.
Mains findMains(const Measured& measured, const StaticFit& fit, const TaxelFit& taxels,
                const DiscrepancyOptions& options);

/// Subtracts the hum's time course from the common traces.
void takeOut(const Mains& mains, const StaticFit& fit, CommonTraces& common);

simulation::EnabledEffect asEffect(const Mains& mains, double full_scale);

/// An effect that a detector found. It is reported beside the explanation of the common trace.
struct Detection {
  FoundEffect effect;
  std::vector<simulation::EnabledEffect> enable;  ///< its settings; empty if it cannot be simulated
  std::vector<std::string> depends_on;
  WhereItShows where;
  double before_more = 0;  ///< squared error of the gap before that the residual does not contain
  double after_less = 0;   ///< squared error that the gap after and the floor do not contain
  bool wrong_form = false;
};

Detection detectionOf(const health::Fault& fault, const FaultyReadings& readings);
Detection detectionOf(const Mains& mains, double square, const Measured& measured);
Detection detectionOf(const Repositioning& repositioning, double square);
/// An effect that wanders at random. On some taxels only, it is stronger there than in the common trace, by
/// `amplitude`.
Detection detectionOf(const RandomFinding& finding, const simulation::EffectInfo& info,
                      const WhereItShows& where, double amplitude);
/// Saturation, with the limit that the static curves of all surfaces have in common.
Detection saturationOf(const StaticMisfit& misfit, const Measured& measured, const StaticFit& fit);

/// isMisfit(): whether the misfit of the static curves is more than chance. isSaturation(): whether a limit
/// of the readings that all surfaces have in common explains it.
bool isMisfit(const StaticMisfit& misfit, bool something_else_found);
bool isSaturation(const StaticMisfit& misfit);

}  // namespace fsr::discrepancy
