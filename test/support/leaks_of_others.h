#pragma once

// Of the leak sanitizer, where there is one.
extern "C" {
void __lsan_disable() __attribute__((weak));
void __lsan_enable() __attribute__((weak));
}

namespace test_support {

/// What is allocated on this thread while it lives may be lost: by another library, for a reason said beside
/// it.
class LeaksOfOthers {
 public:
  LeaksOfOthers() {
    if (__lsan_disable != nullptr) __lsan_disable();
  }
  ~LeaksOfOthers() {
    if (__lsan_enable != nullptr) __lsan_enable();
  }
  LeaksOfOthers(const LeaksOfOthers&) = delete;
  LeaksOfOthers& operator=(const LeaksOfOthers&) = delete;
};

}  // namespace test_support
