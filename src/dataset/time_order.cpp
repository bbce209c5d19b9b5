#include "dataset/time_order.h"

#include <algorithm>
#include <numeric>

namespace fsr::dataset {

std::vector<std::size_t> inOrderOfTime(const std::vector<Recording>& recordings) {
  std::vector<std::size_t> order(recordings.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return recordings[a].start_ns < recordings[b].start_ns;
  });
  return order;
}

}  // namespace fsr::dataset
