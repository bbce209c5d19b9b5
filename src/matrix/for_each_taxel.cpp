#include "matrix/for_each_taxel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>
#include <vector>

namespace fsr::matrix {

void forEachTaxel(std::size_t taxels, unsigned threads, const std::function<void(std::size_t)>& work) {
  std::vector<std::exception_ptr> failure(taxels);
  std::atomic<std::size_t> next{0};
  const auto run = [&] {
    for (std::size_t taxel = next++; taxel < taxels; taxel = next++) {
      try {
        work(taxel);
      } catch (...) {
        failure[taxel] = std::current_exception();
      }
    }
  };
  if (threads == 0) threads = std::max(1u, std::thread::hardware_concurrency());
  std::vector<std::thread> others;
  try {
    for (std::size_t i = 1; i < std::min<std::size_t>(threads, taxels); ++i) others.emplace_back(run);
  } catch (const std::exception&) {
    // The system gives no further thread, or no memory for one: those that run do the whole work.
  }
  run();
  for (std::thread& other : others) other.join();
  for (const std::exception_ptr& thrown : failure) {
    if (thrown) std::rethrow_exception(thrown);
  }
}

}  // namespace fsr::matrix
