#pragma once

// Functions of the leak sanitizer, if the build has one.
extern "C" {
void __lsan_disable() __attribute__((weak));
void __lsan_enable() __attribute__((weak));
}

namespace test_support {

/// While this object exists, the leak sanitizer ignores memory that is allocated on this thread and lost. For
/// leaks of other libraries; the reason is given where it is used.
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
