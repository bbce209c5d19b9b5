#pragma once

#include <vector>

#include "dataset/mounts/mount_remarks.h"
#include "fsr_pressure_map/dataset/recording.h"

namespace fsr::dataset {

/// One remark for each mount that differs more from the others of its surface than mounts of one surface do
/// in these recordings, e.g. because it lay on another surface than declared. The largest difference comes
/// first. Where a surface has two mounts that differ, one remark names both: either may be wrong.
///
/// A mount's distance is the root mean square, over the pressure bins, of the pressure by which it differs at
/// equal readings (median of the taxels). Dwells do not count; loading and unloading count the same. Its
/// square is compared with the scatter of all other mounts around the means of their surfaces, as
/// session::SurfaceWatch does: an F test with one degree of freedom, which is the widest scatter that bins
/// and taxels can have together; its p is corrected for the number of mounts (Bonferroni). Up to 1 in 20 the
/// mount stands out: it is left out, and the rest is tested again. Up to 1 in 2, the sentence says that it may
/// be chance. Distances below half of the sheet's loop (root mean square of half of unloading minus loading)
/// are left out: they add less to the error than the loop does.
///
/// No remark where the scatter is unknown (no other surface was mounted twice), without a chamber, and of
/// surfaces without name or mounts without number. Recordings of different matrices are not compared.
std::vector<MountRemark> remarksOnDifferingMounts(const std::vector<Recording>& recordings);

}  // namespace fsr::dataset
