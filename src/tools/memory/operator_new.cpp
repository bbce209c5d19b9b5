// operator new of the tools that read bags: once they hold 160 MB, large blocks lie in files (file_blocks.h).
// It is part of their programs and not of the library, whose users keep their own.

#include <cstdlib>
#include <new>

#include "tools/memory/file_blocks.h"

namespace file_blocks = fsr::tools::file_blocks;

void* operator new(std::size_t size) {
  if (file_blocks::belongsInFile(size)) {
    if (void* const block = file_blocks::make(size)) return block;
  }
  if (void* const memory = std::malloc(size != 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}

void operator delete(void* memory) noexcept {
  if (memory != nullptr && !file_blocks::release(memory)) std::free(memory);
}

void* operator new[](std::size_t size) {
  return operator new(size);
}

void operator delete[](void* memory) noexcept {
  operator delete(memory);
}

void operator delete(void* memory, std::size_t /*size*/) noexcept {
  operator delete(memory);
}

void operator delete[](void* memory, std::size_t /*size*/) noexcept {
  operator delete(memory);
}
