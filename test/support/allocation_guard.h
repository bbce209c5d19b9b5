#pragma once

#include <cstddef>

namespace test_support {

/// Counts the allocations by operator new on this thread since the guard was made. Linking
/// allocation_guard.cpp replaces operator new of the whole test executable. Under a sanitizer, malloc is
/// counted, too.
class AllocationGuard {
 public:
  AllocationGuard();
  std::size_t allocations() const;

 private:
  std::size_t before_;
};

}  // namespace test_support
