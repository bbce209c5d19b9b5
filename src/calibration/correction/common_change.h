#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "calibration/correction/correction_fit.h"
#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr::calibration {

/// What one mount of the recheck seems to have changed, against the training.
struct MountChange {
  std::size_t surface = 0;  ///< 0, 1, ...
  /// Coordinates in which the sum of squares is the mean square of what the change does to the pressure [Pa].
  std::vector<double> change;
};

/// How much the mounts of a sheet scatter.
struct MountScatter {
  double deviation = std::numeric_limits<double>::quiet_NaN();  ///< of one mount [Pa]; NaN = not known
  std::size_t freedom = 0;                                      ///< degrees of freedom; 0 = not known

  bool known() const { return freedom > 0; }
};

/// The change that all mounts have in common, against what mounts alone do.
struct CommonChange {
  double size = 0;  ///< root mean square of what it does to the pressure [Pa]
  MountScatter scatter;
  /// Probability that mounts alone do as much or more; 1 where their scatter is not known.
  double p = 1;
};

/// Tests a change that all mounts have in common. Each surface s was mounted m_s times in the training and is
/// mounted k_s times in the recheck. With the change of the sheet c, mounts of the training b and of the
/// recheck e, all mounts with the same scatter,
///
///     d_sj = c + e_sj - mean(b_s),   mean of d_s over j: variance sigma^2 (1/k_s + 1/m_s).
///
/// c is the mean over surfaces, weighted by their inverse variances. sigma^2 comes from what the mounts
/// differ by, sum(k_s) - 1 degrees of freedom, or from the training, whichever has more degrees of freedom.
/// p is that of Student's t, exact for one coordinate. Where a change has several coordinates, squares add
/// up, and p is on the safe side below 0.2: with a known sigma a single coordinate has the heaviest tail (G.
/// J. Szekely, N. K. Bakirov, Probab. Theory Relat. Fields 126, 2003, 184), and common_change_test draws
/// sheets for an estimated one.
///
/// `trained_mounts`: [surfaces], m_s. `trained`: the scatter that the training knows.
CommonChange testCommonChange(const std::vector<MountChange>& mounts,
                              const std::vector<std::size_t>& trained_mounts, const MountScatter& trained);

/// A recheck on mounts that are not those of the training.
struct MountTest {
  std::size_t mounts = 0;  ///< of all surfaces; a recording without a number is of mount 0
  CommonChange sheet;      ///< gain and offset of the whole sheet
  CommonChange taxels;     ///< those of each taxel beside the sheet's
};

/// Each stay of the readings with another number on a surface is another mount.
MountTest testMounts(const Calibration& parent, const RecheckReadings& readings, const CorrectionFit& fit);

/// RMSE on cycles that were left out where each mount has gains and offsets of its own, by taxel [Pa]: what
/// is left where mounts explain all they can. Infinite where no mount has two cycles.
double errorWithinMounts(const CorrectionFit& fit);

/// The scatter of mounts that the training of the calibration measured, from one reading to the next, which
/// is at least that of the whole sheet.
MountScatter trainedScatter(const Calibration& parent);

}  // namespace fsr::calibration
