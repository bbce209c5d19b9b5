#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "fsr_pressure_map/dataset/recording.h"

namespace fsr::dataset {

inline constexpr double kCertain = 0.05;  ///< what chance makes less often is certain

/// A sentence about a recording.
struct MountRemark {
  std::size_t recording = 0;  ///< index
  std::string sentence;
  double by_chance =
      0;  ///< share of recordings without any mistake that get such a remark; 0 = not by chance

  bool certain() const { return by_chance < kCertain; }
};

/// Mounts are told apart by surface and number alone. One remark for each surface and number under which two
/// recordings were made with a night between them: the matrix may have been taken off, and the number kept.
std::vector<MountRemark> remarksOnMounts(const std::vector<Recording>& recordings);

/// One remark for each mount that differs more from the others of its surface than mounts of one surface do
/// in these recordings, e.g. because it lay on another surface than declared. The largest difference comes
/// first. Where a surface has two mounts that differ, one remark names both: either may be wrong.
///
/// A mount's distance is the root mean square, over the pressure bins, of the pressure by which it differs at
/// equal readings (median of the taxels). Dwells do not count; loading and unloading count the same. Its
/// square is compared with the scatter of all other mounts around the means of their surfaces, as
/// session::SurfaceWatch does: an F test with one degree of freedom, which is the widest scatter that bins
/// and taxels can have together; its p is corrected for the number of mounts (Bonferroni). Up to 1 in 20 the
/// mount stands out: it is left out, and the rest is tested again. Up to 1 in 2, the sentence says that it
/// may be chance. Distances below half of the sheet's loop (root mean square of half of unloading minus
/// loading) are left out: they add less to the error than the loop does.
///
/// No remark where the scatter is unknown (no other surface was mounted twice), without a chamber, and of
/// surfaces without name or mounts without number. Recordings of different matrices are not compared.
std::vector<MountRemark> remarksOnDifferingMounts(const std::vector<Recording>& recordings);

}  // namespace fsr::dataset
