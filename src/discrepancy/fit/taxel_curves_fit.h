#pragma once

#include <string>

#include "discrepancy/samples/views.h"

namespace fsr::discrepancy {

/// Returns the simulation with curves of single taxels added (see TaxelCurves): one for each taxel and each
/// class of curvature, as a function of the load that the chain computes with the effects that the simulation
/// enables. They are penalised cubic splines through at most 40 knots: least squares plus second differences,
/// with the weight of the latter by generalised cross-validation, one for each surface (P. Eilers, B. Marx,
/// Statist. Sci. 11 (1996) 89; Y.-J. Kim, C. Gu, J. R. Statist. Soc. B 66 (2004) 337). The static curve with
/// its deviation never falls (K. Bollaerts, P. Eilers, I. van Mechelen, Statist. Med. 25 (2006) 1552). Beyond
/// their ends they are straight lines. Effects that come and go at random are left out while they are fitted.
/// `file` is the name of the table in the settings.
simulation::SimulationSettings withTaxelCurves(const FitView& fit,
                                               const simulation::SimulationSettings& simulation,
                                               const std::string& file);

}  // namespace fsr::discrepancy
