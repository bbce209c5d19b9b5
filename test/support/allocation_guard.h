#pragma once

#include <cstddef>

namespace test_support {

/// Counts what operator new was asked for on this thread since the guard was made. Linking
/// allocation_guard.cpp replaces operator new of the whole test executable; under a sanitizer malloc counts too.
class AllocationGuard {
 public:
  AllocationGuard();
  std::size_t allocations() const;

 private:
  std::size_t before_;
};

}  // namespace test_support
