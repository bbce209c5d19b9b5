#pragma once

#include <cstddef>

namespace fsr::tools {

/// Blocks of memory that lie in files without names (TMPDIR, else /var/tmp), so that a tool takes as much
/// memory for a bag of days as for one of minutes. The system writes them out and reads them again as it
/// needs; what of them is resident is given back whenever it is more than a third of the limit.
///
/// From any thread. No function throws or allocates with operator new, which calls them.
namespace file_blocks {

/// Smallest block that is kept in a file [bytes].
constexpr std::size_t kSmallest = std::size_t{64} << 10;
/// Memory that a tool takes, unless setLimit() says otherwise [bytes].
constexpr std::size_t kUsualLimit = std::size_t{320} << 20;

/// Memory that a tool shall take [bytes]: up to a half in blocks of its own, up to a third in pages of files.
void setLimit(std::size_t bytes);

/// Whether a block of `size` bytes belongs in a file: it is large, and with it the process's own memory would
/// exceed half of the limit.
bool belongsInFile(std::size_t size);

/// A block of at least `size` bytes, page-aligned, with any content. Null where a file cannot be made or has
/// no room.
void* make(std::size_t size);

/// Gives a block back. False where `block` is not one of make()'s: nothing is done then.
bool release(void* block);

}  // namespace file_blocks
}  // namespace fsr::tools
