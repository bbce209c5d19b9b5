#include "dataset/mounts/mount_remarks.h"

#include <cstdint>
#include <map>
#include <set>
#include <utility>

#include "dataset/time_order.h"
#include "settings/number_text.h"

namespace fsr::dataset {

namespace {

constexpr double kNight = 8;  // [h]

double hoursBetween(const Recording& first, const Recording& second) {
  const double end = first.time.empty() ? 0 : first.time.back();
  return (1e-9 * (static_cast<double>(second.start_ns) - static_cast<double>(first.start_ns)) - end) / 3600;
}

}  // namespace

std::vector<MountRemark> remarksOnMounts(const std::vector<Recording>& recordings) {
  using Mount = std::pair<std::string, std::uint32_t>;
  std::map<Mount, std::size_t> last;  // the recording before, on each mount
  std::set<Mount> told;
  std::vector<MountRemark> remarks;
  for (const std::size_t r : inOrderOfTime(recordings)) {
    for (const matrix::Surface& surface : recordings[r].conditions) {
      const Mount mount{surface.name, surface.mount};
      if (surface.mount == 0 || surface.name.empty()) continue;
      const auto before = last.find(mount);
      const double hours = before == last.end() ? 0 : hoursBetween(recordings[before->second], recordings[r]);
      if (hours >= kNight && told.insert(mount).second) {
        remarks.push_back(
            {r, surface.name + ", mount " + std::to_string(surface.mount) + ": " + recordings[r].name +
                    " begins " + settings::fixedText(hours, 0) + " h after the end of " +
                    recordings[before->second].name +
                    "; if the matrix was taken off in between, these are two mounts under one "
                    "number, and the stated error of another mount leaves their difference out"});
      }
      last[mount] = r;
    }
  }
  return remarks;
}

}  // namespace fsr::dataset
