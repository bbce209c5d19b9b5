#pragma once

#include <cstddef>
#include <vector>

#include "calibration/correction/recheck_readings.h"

namespace fsr::calibration {

/// What has changed at a taxel: it reads `offset + gain * code` where it read `code` when the parent was
/// trained.
struct ReadingChange {
  double gain = 1;
  double offset = 0;  ///< [counts]

  double before(double code) const { return (code - offset) / gain; }
};

/// The models of a change, from the simplest to the richest.
enum class ChangeModel {
  kNone,   ///< nothing has changed
  kSheet,  ///< gain and offset of all taxels are the same
  kTaxels  ///< each taxel has its own, drawn towards those of the sheet
};
constexpr std::size_t kChangeModels = 3;

/// Squared errors of readings.
struct SquaredErrors {
  double sum = 0;       ///< [Pa^2]
  double expected = 0;  ///< of the stated deviations [Pa^2]
  std::size_t readings = 0;

  double mean() const { return sum / double(readings); }
};

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
  explicit CorrectionFit(const RecheckReadings& readings);

  /// Whether each cycle takes part in a fit.
  using Cycles = std::vector<bool>;

  /// [taxels], fitted to the cycles.
  std::vector<ReadingChange> fit(ChangeModel model, const Cycles& cycles) const;

  /// What the change of the whole sheet, fitted to the cycles, does to the pressure. Squares of the two
  /// coordinates add up to the mean square over all readings [Pa].
  std::vector<double> sheetEffect(const Cycles& cycles) const;
  /// [2 * taxels], likewise, what each taxel changes beside the sheet, not drawn towards it [Pa].
  std::vector<double> taxelEffects(const Cycles& cycles) const;

  const RecheckReadings& readings() const { return readings_; }

  /// Errors of the readings of one cycle, if the sheet has changed so.
  SquaredErrors errors(const std::vector<ReadingChange>& changes, std::size_t cycle) const;

 private:
  // Normal equations of shift and stretch of the counts of some readings.
  struct Sums {
    double a = 0, b = 0, d = 0;  // matrix (a, b; b, d)
    double shift = 0, stretch = 0;

    void add(const Sums& other);
    // False where the readings do not determine both.
    bool solve(double& shift_out, double& stretch_out) const;
  };
  // Counts = pivot + shift + (1 + stretch) (counts before - pivot).
  struct Change {
    double shift = 0;    // [counts]
    double stretch = 0;  // ratio
  };

  using CycleSums = std::vector<Sums>;  // [cycles]

  ReadingChange toReading(Change change) const;
  Sums sheetTotal(const Cycles& cycles) const;
  // The change of the whole sheet; that of all cycles where these do not determine it.
  Change sheetOf(const Cycles& cycles) const;
  // Adds the coordinates of a change of the readings behind `sums` to `effects`.
  void addEffect(const Sums& sums, Change change, std::vector<double>& effects) const;
  // Of one taxel around a change. `error`: sum of the squared errors [Pa^2].
  CycleSums sumsAround(Change centre, std::size_t taxel, double& error) const;
  static Sums totalOf(const CycleSums& sums, const Cycles& cycles);
  void fitSheet();
  void fitTaxel(std::size_t taxel);
  // The change of one taxel without regard to the others; false where its readings do not determine it.
  bool alone(std::size_t taxel, const Sums& sums, Change& change) const;
  std::vector<Change> shrunk(const Cycles& cycles, Change sheet) const;
  Change jackknifeVariance(std::size_t taxel, const Cycles& cycles, Change whole) const;

  const RecheckReadings& readings_;
  double pivot_ = 0;                   // mean reading [counts]
  double number_ = 0;                  // of readings
  Change sheet_;                       // fitted to all cycles
  std::vector<CycleSums> sheet_sums_;  // [taxels], around `sheet_`
  std::vector<Change> taxels_;         // [taxels], each fitted to all cycles
  std::vector<CycleSums> taxel_sums_;  // [taxels], around its own change
};

}  // namespace fsr::calibration
