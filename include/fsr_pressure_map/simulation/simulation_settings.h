#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "fsr_pressure_map/matrix/curvature.h"
#include "fsr_pressure_map/matrix/layout.h"
#include "fsr_pressure_map/simulation/chamber.h"
#include "fsr_pressure_map/simulation/effect_info.h"

namespace fsr::simulation {

/// Where on the sheet the pressure acts: everywhere (gas), or under a disc or on one side of an edge
/// (indenter). Uneven loads make effects visible that uniform ones hide, e.g. crosstalk.
struct LoadPattern {
  enum class Kind { kUniform, kDisc, kEdge };
  Kind kind = Kind::kUniform;
  matrix::Position centre;  ///< of the disc; a point of the edge [m]
  double radius = 0;        ///< of the disc [m]
  double angle = 0;         ///< from x to the edge's loaded side [rad]
};

/// Loaded share of the cell of each taxel, which is one pitch wide and high, [rows x columns], row-major.
/// Exactly 1 everywhere for the uniform load.
std::vector<double> loadShares(const LoadPattern& pattern, const matrix::Layout& layout);

struct TaxelCurves;   // src/simulation/taxel_curves.h
class EffectLibrary;  // src/simulation/effects/effect_library.h

/// The simulated board, except for its effects on the readings.
struct SimulatedBoard {
  std::string serial = "SIM-0001";
  std::string firmware = "1.0.0";
  std::string model = "simulated";
  double scan_rate = 10;        ///< [Hz]
  double scan_duration = 0;     ///< first to last taxel [s], 0 = all at once
  double transducer_rate = 10;  ///< [Hz], 0 = no transducer on this link
};

/// Throws InputError where a scan takes longer than the time from one scan to the next. Messages use `origin`
/// as the name of the file.
void validate(const SimulatedBoard& board, const std::string& origin);

constexpr double kForever = 1e9;  ///< an end that no recording reaches [s]

/// A time in which a taxel or a line fails.
struct FaultSpell {
  std::size_t taxel = 0;    ///< row-major; of row_fault and column_fault: index of the line
  double from = 0, to = 0;  ///< rig time [s]
  /// Of a stuck taxel [counts]; -1 = what it was when the fault began. Of a line: share of the conductance
  /// that is lost.
  double reading = 0;
};

/// An effect that is enabled, with all its parameters.
struct EnabledEffect {
  std::string id;
  EffectValues values;
  std::vector<std::size_t> only_taxels{};    ///< on which it acts, row-major; empty = all
  std::vector<std::string> only_surfaces{};  ///< by name; empty = all
  std::vector<FaultSpell> spells{};          ///< of faults, in place of their parameters
  bool carried_over = true;                  ///< its memory outlasts a new mounting
};

/// One mount of the matrix and the program of the chamber during it. It becomes one bag.
struct Station {
  matrix::Surface surface;  ///< mounts are numbered from 1
  LoadPattern load;
  double pause = 60;  ///< rest before it, which is not recorded [s]
  ChamberProgram program;
};

/// A simulated rig: config/simulation/*.yaml.
struct SimulationSettings {
  std::string origin;  ///< the file, for messages
  std::string name;
  std::uint64_t seed = 1;
  matrix::Layout layout{{7, 10}, 0.010, 0.010};
  SimulatedBoard board;
  ChamberProtocol chamber;       ///< cycles that the emulator runs
  std::vector<Station> session;  ///< stations of `simulate`, at least one
  double start = 1704099600;     ///< date of rig time 0 [s since 1970]
  ChamberClimate climate;
  Transducer transducer;
  std::vector<EnabledEffect> effects;  ///< in the library's order
  std::shared_ptr<const TaxelCurves>
      taxel_curves;               ///< deviations of single taxels from the static curve; may be null
  std::string taxel_curves_file;  ///< their file, as the settings name it

  std::shared_ptr<const EffectLibrary> library;  ///< of `effects`; null = the effects of this package

  /// nullptr where it is not enabled.
  const EnabledEffect* effect(const std::string& id) const;
  /// Largest count of the converter.
  std::uint16_t fullScale() const;
};

/// Reads and checks a file strictly. Form (all but `simulation` and `effects` may be left out):
///
///     simulation: demo
///     seed: 1
///     matrix: {rows: 7, columns: 10, pitch_x: 0.010, pitch_y: 0.010}   # [m]
///     board: {serial: SIM-0001, scan_rate: 10, ...}                    # fields of SimulatedBoard
///     chamber: {peak: 620000, rate: 17000, cycles: 10, ...}            # see readChamberProtocol()
///     program: [{cycles: {...}}, {hold: {...}}, ...]   # see readChamberProgram(); else `chamber`
///     session:                                         # else once on the flat
///       - {surface: cylinder_5cm}                      # ../surfaces/cylinder_5cm.yaml, seen from this file
///       - {surface: saddle, two_planes: {x: 5, y: -3}, pause: 600, load: {disc: {radius: 0.02}}}
///     start: 1704099600                                                # date of the first scan
///     climate: {room: [{time: 0, temperature: 23}, ...], heating: 0}   # see readChamberClimate()
///     transducer: {low: -103000, high: 1034000, full_counts: 4096}
///     effects:
///       static_curve: {exponent: 0.9}   # effects that are named are enabled; {} = usual values
///       creep: {only_taxels: [0, 12], only_surfaces: [flat]}   # row-major; acts nowhere else
///     taxel_curves: taxel_curves.csv    # beside this file; see TaxelCurves
///
/// Throws InputError that names unknown effects and keys, and values out of range.
SimulationSettings readSimulationFile(const std::string& path);

}  // namespace fsr::simulation
