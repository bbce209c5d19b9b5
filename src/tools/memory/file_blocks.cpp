#include "tools/memory/file_blocks.h"

#include <fcntl.h>
#include <pthread.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <mutex>
#include <new>
#include <unordered_map>
#include <utility>

namespace fsr::tools::file_blocks {

namespace {

constexpr std::size_t kPage = 4096;
// Freed blocks that are kept for the next of their size: making one anew costs its first touch of every page.
constexpr std::size_t kSpare = std::size_t{64} << 20;
constexpr unsigned kLookEvery = 4000;  // at the resident memory [us]

std::atomic<std::size_t> limit{kUsualLimit};

// Allocates with malloc: the tables below serve operator new.
template <typename T>
struct Malloc {
  using value_type = T;
  Malloc() = default;
  template <typename U>
  Malloc(const Malloc<U>& /*other*/) {}
  T* allocate(std::size_t n) {
    void* const memory = std::malloc(n * sizeof(T));
    if (memory == nullptr) throw std::bad_alloc();
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t /*n*/) { std::free(memory); }
  friend bool operator==(const Malloc& /*a*/, const Malloc& /*b*/) { return true; }
  friend bool operator!=(const Malloc& /*a*/, const Malloc& /*b*/) { return false; }
};

struct Blocks {
  template <typename Key, typename Value>
  using Entry = Malloc<std::pair<const Key, Value>>;

  std::mutex mutex;
  std::unordered_map<void*, std::size_t, std::hash<void*>, std::equal_to<>, Entry<void*, std::size_t>> used;
  std::multimap<std::size_t, void*, std::less<>, Entry<std::size_t, void*>> spare;  // by size
  std::size_t spare_bytes = 0;
  bool watched = false;
};

// Never destroyed: memory is freed until the very end of the process.
Blocks& all() {
  static Blocks* const blocks = new (std::malloc(sizeof(Blocks))) Blocks;
  return *blocks;
}

struct Resident {
  std::size_t own = 0, mapped = 0;  // [bytes]
};

// /proc/self/statm: size, resident, shared (pages of files) ... [pages]. Zeros where it cannot be read.
Resident resident() {
  static const int file = ::open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  char text[128];
  const ssize_t read = file < 0 ? -1 : ::pread(file, text, sizeof(text) - 1, 0);
  if (read <= 0) return {};
  text[read] = '\0';
  std::size_t pages = 0, mapped = 0;
  if (std::sscanf(text, "%*u %zu %zu", &pages, &mapped) != 2 || mapped > pages) return {};
  return {(pages - mapped) * kPage, mapped * kPage};
}

// Takes the pages of all blocks out of the process. Their content stays in their files.
void giveBack(Blocks& blocks) {
  const std::lock_guard<std::mutex> lock(blocks.mutex);
  for (const auto& [block, size] : blocks.used) ::madvise(block, size, MADV_DONTNEED);
  for (const auto& [size, block] : blocks.spare) ::madvise(block, size, MADV_DONTNEED);
}

[[noreturn]] void* watch(void* /*unused*/) {
  for (;;) {
    ::usleep(kLookEvery);
    if (resident().mapped > limit / 3) giveBack(all());
  }
}

void* mapNewFile(std::size_t size) {
  const char* const folder = std::getenv("TMPDIR");
  char name[512];
  const int length = std::snprintf(name, sizeof(name), "%s/fsr_memory_XXXXXX",
                                   folder != nullptr && *folder != '\0' ? folder : "/var/tmp");
  if (length < 0 || static_cast<std::size_t>(length) >= sizeof(name)) return nullptr;
  const int file = ::mkostemp(name, O_CLOEXEC);
  if (file < 0) return nullptr;
  ::unlink(name);
  // Room is taken at once: a page that finds the disk full later would end the process.
  void* block = MAP_FAILED;
  if (::fallocate(file, 0, 0, static_cast<off_t>(size)) == 0)
    block = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  ::close(file);
  return block == MAP_FAILED ? nullptr : block;
}

// A freed block of nearly this size; null where there is none.
void* takeSpare(Blocks& blocks, std::size_t size) {
  const auto found = blocks.spare.lower_bound(size);
  if (found == blocks.spare.end() || found->first > size + size / 4) return nullptr;
  void* const block = found->second;
  blocks.used.emplace(block, found->first);
  blocks.spare_bytes -= found->first;
  blocks.spare.erase(found);
  return block;
}

void startWatch(Blocks& blocks) {
  pthread_t thread;
  if (blocks.watched || ::pthread_create(&thread, nullptr, watch, nullptr) != 0) return;
  ::pthread_detach(thread);
  blocks.watched = true;
}

}  // namespace

void setLimit(std::size_t bytes) {
  limit = bytes;
}

bool belongsInFile(std::size_t size) {
  return size >= kSmallest && resident().own + size > limit / 2;
}

void* make(std::size_t size) {
  size = (size + kSmallest - 1) / kSmallest * kSmallest;
  Blocks& blocks = all();
  try {
    {
      const std::lock_guard<std::mutex> lock(blocks.mutex);
      if (void* const block = takeSpare(blocks, size)) return block;
    }
    void* const block = mapNewFile(size);
    if (block == nullptr) return nullptr;
    const std::lock_guard<std::mutex> lock(blocks.mutex);
    blocks.used.emplace(block, size);
    startWatch(blocks);
    return block;
  } catch (const std::bad_alloc&) {  // the tables are out of memory, and then all is over anyway
    return nullptr;
  }
}

bool release(void* block) {
  // malloc's blocks have a header before them and are hardly ever on a page's edge.
  if (reinterpret_cast<std::uintptr_t>(block) % kPage != 0) return false;
  Blocks& blocks = all();
  const std::lock_guard<std::mutex> lock(blocks.mutex);
  const auto found = blocks.used.find(block);
  if (found == blocks.used.end()) return false;
  const std::size_t size = found->second;
  blocks.used.erase(found);
  if (blocks.spare_bytes + size > kSpare) return ::munmap(block, size) == 0;
  try {
    blocks.spare.emplace(size, block);
    blocks.spare_bytes += size;
  } catch (const std::bad_alloc&) {
    ::munmap(block, size);
  }
  return true;
}

}  // namespace fsr::tools::file_blocks
