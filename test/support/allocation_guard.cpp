#include "support/allocation_guard.h"

#include <cstdlib>
#include <new>

#if defined(__has_feature)
#define BUILT_WITH(sanitizer) __has_feature(sanitizer)
#else
#define BUILT_WITH(sanitizer) 0
#endif

namespace {

thread_local std::size_t allocations_on_this_thread = 0;

}  // namespace

#if BUILT_WITH(address_sanitizer) || BUILT_WITH(thread_sanitizer)

// A sanitizer has its own operator new, which reports allocations to a hook.
#include <sanitizer/allocator_interface.h>

namespace {

void count(const volatile void*, std::size_t) {
  ++allocations_on_this_thread;
}
void passOver(const volatile void*) {}
const int installed = __sanitizer_install_malloc_and_free_hooks(count, passOver);

}  // namespace

#else

namespace {

void* counted(std::size_t size) {
  ++allocations_on_this_thread;
  if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}

void* countedAligned(std::size_t size, std::align_val_t alignment) {
  ++allocations_on_this_thread;
  const std::size_t step = static_cast<std::size_t>(alignment);
  if (void* memory = std::aligned_alloc(step, (size + step - 1) / step * step)) return memory;
  throw std::bad_alloc();
}

}  // namespace

// The default forms of new and delete for arrays and with nothrow call these.
void* operator new(std::size_t size) {
  return counted(size);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return countedAligned(size, alignment);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

#endif

namespace test_support {

AllocationGuard::AllocationGuard() : before_(allocations_on_this_thread) {}

std::size_t AllocationGuard::allocations() const {
  return allocations_on_this_thread - before_;
}

}  // namespace test_support
