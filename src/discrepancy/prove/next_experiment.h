#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <string>
#include <vector>

#include "discrepancy/fit/cycle_noise.h"
#include "discrepancy/samples/available_evidence.h"
#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/discrepancy/discrepancy.h"

namespace fsr::discrepancy {

/// The protocols that nextExperiment() chooses from.
std::vector<std::string> protocolNames();

/// The simulation with the surfaces of the recordings instead of its own, by ascending curvature.
simulation::SimulationSettings onItsSurfaces(simulation::SimulationSettings rig, const Measured& measured);

/// The rig under one run of a protocol, on its first and its last surface. `hours_apart` uses the first only.
/// All pressures and rates are scaled to `peak`, the highest pressure of the chamber [Pa]; times stay.
simulation::SimulationSettings runProtocol(const std::string& protocol, simulation::SimulationSettings rig,
                                           double peak);

/// The explanations that an experiment is to decide between, and the rig that runs it.
struct Contest {
  std::vector<std::vector<simulation::EnabledEffect>> explanations;
  std::vector<double> weights;        ///< probability of each explanation if one of them is true
  double unknown = 0;                 ///< probability that none of them is true
  std::vector<std::string> untested;  ///< effects that could not compete for lack of evidence
  AvailableEvidence at_hand;
  NoiseOfCycles noise;      ///< of the mean reading
  double peak = 620e3;      ///< highest pressure of the chamber [Pa]
  std::size_t draws = 299;  ///< of each truth
  std::uint64_t seed = 1;
};

/// What is known after an experiment, in the mean over the truths and the noise.
struct ExpectedKnowledge {
  double entropy = 0;    ///< of the explanations and `unknown` [nats]
  double certainty = 0;  ///< probability of the truth
};

/// `gram`: products of what the explanations add to the readings of an experiment, under its noise
/// [explanations x explanations]. The truth adds what it was fitted to; each explanation is judged with a
/// size of its own, normal with variance 1, and `unknown` is any mixture of them, with the same sizes.
ExpectedKnowledge expectedKnowledge(const Eigen::MatrixXd& gram, const Contest& contest);

/// Recommends the protocol that leaves the least expected entropy over the explanations and `unknown`. Each
/// protocol that a rig can run is simulated with each explanation, scaled to the chamber's highest pressure,
/// and repeated until the entropy is that of 95 % on one explanation, or until nobody would record more.
/// Among protocols that leave the same, the shortest is taken. Protocols that provide the evidence that is
/// missing for naming an effect alone are preferred. Where one is not enough, a second one follows. None for
/// fewer than two explanations, and where no protocol tells anything.
std::vector<NextExperiment> nextExperiment(const simulation::SimulationSettings& base,
                                           const Contest& contest);

/// Proposes an experiment that varies covariates on which an unknown discrepancy depends. `proved`: whether
/// something was held out; else more cycles of the same protocol are proposed. `peak`: as in Contest.
std::vector<NextExperiment> experimentFor(const std::vector<std::string>& covariates, bool proved,
                                          double peak);

}  // namespace fsr::discrepancy
