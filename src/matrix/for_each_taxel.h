#pragma once

#include <cstddef>
#include <functional>

namespace fsr::matrix {

/// Calls work(taxel) for each taxel 0 .. taxels - 1, shared over `threads` (0 = one for each core). Each
/// call must write to places of its taxel alone; then the result does not depend on the threads. An
/// exception of the lowest taxel that threw is passed on.
void forEachTaxel(std::size_t taxels, unsigned threads, const std::function<void(std::size_t)>& work);

}  // namespace fsr::matrix
