#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "check/check.h"
#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/dataset/recording.h"

// A correction of gain and offset in counts: its readings, its fit, its choice, and what mounts alone do.
namespace fsr::check {

/// What one taxel answers to each code on one surface.
struct AnswerTable {
  std::vector<float> pressure;   ///< [codes] [Pa]; empty = the taxel has no model
  std::vector<float> deviation;  ///< [codes] [Pa]

  /// Linear between the codes, constant beyond them.
  static double at(const std::vector<float>& values, double code);
  /// Change of the pressure with the code, over a window of a few codes [Pa/count].
  double slopeAt(double code) const;
};

/// One reading of a taxel with the pressure that its table should answer.
struct Reading {
  std::uint16_t code = 0;
  float pressure = 0;  ///< [Pa]
};
using TaxelReadings = std::vector<std::vector<Reading>>;  ///< [taxels]

/// The readings of the cycles that count.
struct CycleReadings {
  /// One stay of the sheet on a surface: a condition of a recording.
  struct Stay {
    std::size_t surface = 0;           ///< index into `surfaces`
    std::uint32_t mount = 0;           ///< number of the mount; 0 = not given
    std::vector<AnswerTable> answers;  ///< [taxels], the tables of the calibration on this surface
    TaxelReadings rest;                ///< at the start, whose error a tare subtracts; empty = no tare
  };
  std::vector<Stay> stays;
  std::vector<std::size_t> stay_of_cycle;  ///< [cycles]
  std::vector<TaxelReadings> cycle;        ///< [cycles]
  std::vector<std::string> surfaces;       ///< names, each once
  std::vector<std::string> remarks;        ///< sentences for the user

  std::size_t cycles() const { return cycle.size(); }
  const Stay& stayOf(std::size_t number) const { return stays[stay_of_cycle[number]]; }
};

/// Reads the counts once. Readings of 0 counts and of full scale are left out, because they are limits.
/// Throws InputError, one sentence, where the recordings do not fit the parent: matrix, converter, board,
/// surface, pressure reference, number of cycles, range of pressure.
CycleReadings gatherCycles(const calibration::Calibration& parent,
                           const std::vector<dataset::Recording>& recordings);

/// Gain and offset by least squares of the pressure, with any cycles left out.
///
/// A change is fitted where it happens, in the counts before the table. Wear multiplies the conductance of
/// a taxel, and counts are proportional to it (zero-potential circuit); a zero of amplifier or converter adds
/// counts. One gain and one offset in counts are therefore right on every surface. In pressure behind the
/// table both would depend on the surface, because bending adds a load that the gain acts on, too.
///
/// The errors of the whole sheet, and of each taxel, are minimised by Gauss-Newton steps. Around a solution
/// the errors are linear in the changes, so that sums for each taxel and cycle give the solution without any
/// cycles. The change of a taxel beside the sheet's is multiplied by tau^2 / (tau^2 + s^2), tau the scatter
/// between taxels and s the jackknife error of the taxel over cycles (James and Stein 1961; B. Efron, C.
/// Morris, JASA 68, 1973, 117).
class CorrectionFit {
 public:
  explicit CorrectionFit(const CycleReadings& readings);

  /// Whether each cycle takes part in a fit.
  using Cycles = std::vector<bool>;

  /// [taxels], fitted to the cycles.
  std::vector<ReadingChange> fit(ChangeModel model, const Cycles& cycles) const;

  /// What the change of the whole sheet, fitted to the cycles, does to the pressure. Squares of the two
  /// coordinates add up to the mean square over all readings [Pa].
  std::vector<double> sheetEffect(const Cycles& cycles) const;
  /// [2 * taxels], likewise, what each taxel changes beside the sheet, not drawn towards it [Pa].
  std::vector<double> taxelEffects(const Cycles& cycles) const;

  const CycleReadings& readings() const { return readings_; }

  /// Errors of the readings of one cycle, if the sheet has changed so.
  CheckedReadings errors(const std::vector<ReadingChange>& changes, std::size_t cycle) const;

 private:
  // Shift [counts] and stretch (ratio): counts = pivot + shift + (1 + stretch) (counts before - pivot).
  using Change = Eigen::Vector2d;
  // Normal equations of a step of the change from some readings.
  struct Sums {
    Eigen::Matrix2d matrix = Eigen::Matrix2d::Zero();
    Eigen::Vector2d right = Eigen::Vector2d::Zero();

    void add(const Sums& more, double sign = 1);
  };
  // A change, and the normal equations around it.
  struct Solution {
    Change centre = Change::Zero();
    std::vector<Sums> sums;  // [cycles]

    Sums total(const Cycles& cycles) const;
    // The change by some sums, where their readings determine it.
    std::optional<Change> solve(const Sums& of) const;
  };

  ReadingChange toReading(const Change& change) const;
  // Adds the coordinates of a change of the readings behind `sums` to `effects`.
  void addEffect(const Sums& sums, const Change& change, std::vector<double>& effects) const;
  // Adds the readings of one taxel to the sums around a change. Returns the sum of the squared errors [Pa^2].
  double addTaxel(std::size_t taxel, Solution& around) const;
  void fitSheet();
  void fitTaxel(std::size_t taxel);
  std::vector<Change> shrunk(const Cycles& cycles, const Change& sheet) const;
  Change jackknifeVariance(const Solution& taxel, const Cycles& cycles, const Change& whole) const;

  const CycleReadings& readings_;
  Cycles all_;                          // every cycle
  double pivot_ = 0;                    // mean reading [counts]
  double number_ = 0;                   // of readings
  Solution sheet_;                      // of all taxels and cycles
  std::vector<Solution> around_sheet_;  // [taxels], around the same change
  std::vector<Solution> taxels_;        // [taxels], each around its own
};

/// Leaves each cycle out once. The choice is nested: within the cycles that are left, each is left out again.
/// Models that are richer than `richest` are not chosen; their RMSE is given all the same.
CorrectionChoice chooseCorrection(const CorrectionFit& fit, ChangeModel richest = ChangeModel::kTaxels);

/// What one mount seems to have changed, against the training.
struct MountChange {
  std::size_t surface = 0;  ///< 0, 1, ...
  /// Coordinates in which the sum of squares is the mean square of what the change does to the pressure [Pa].
  std::vector<double> change;
};

/// Tests a change that all mounts have in common. Each surface s was mounted m_s times in the training and is
/// mounted k_s times now. With the change of the sheet c, mounts of the training b and of today e, all
/// mounts with the same scatter,
///
///     d_sj = c + e_sj - mean(b_s),   mean of d_s over j: variance sigma^2 (1/k_s + 1/m_s).
///
/// c is the mean over surfaces, weighted by their inverse variances. sigma^2 comes from what the mounts
/// differ by, sum(k_s) - 1 degrees of freedom, or from the training, whichever has more degrees of freedom.
/// p is that of Student's t, exact for one coordinate. Where a change has several coordinates, squares add
/// up, and p is on the safe side below 0.2: with a known sigma a single coordinate has the heaviest tail (G.
/// J. Szekely, N. K. Bakirov, Probab. Theory Relat. Fields 126, 2003, 184), and mount_test_test draws
/// sheets for an estimated one.
///
/// `trained_mounts`: [surfaces], m_s. `trained`: the scatter that the training knows.
CommonChange testCommonChange(const std::vector<MountChange>& mounts,
                              const std::vector<std::size_t>& trained_mounts, const MountScatter& trained);

/// Each stay of the readings with another number on a surface is another mount.
MountTest testMounts(const calibration::Calibration& parent, const CorrectionFit& fit);

/// RMSE on cycles that were left out where each mount has gains and offsets of its own, by taxel [Pa]: what
/// is left where mounts explain all they can. Infinite where no mount has two cycles.
double errorWithinMounts(const CorrectionFit& fit);

/// The scatter of mounts that the training of the calibration measured, from one reading to the next, which
/// is at least that of the whole sheet.
MountScatter trainedScatter(const calibration::Calibration& parent);

/// The parent with every table moved along the codes, so that it answers to a reading of today what it
/// answered to the reading that stood for the same load before. The map costs the same. `changes`: [taxels].
/// `larger`: factor of the deviations, 1 or more. The sums behind the tables are left out: they are of
/// readings before the change.
calibration::Calibration movedCalibration(const calibration::Calibration& parent,
                                          const std::vector<ReadingChange>& changes, double larger);

}  // namespace fsr::check
