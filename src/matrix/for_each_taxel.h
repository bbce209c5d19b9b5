#pragma once

#include <cstddef>
#include <functional>

namespace fsr::matrix {

/// Calls work(taxel) for each taxel 0 .. taxels - 1 on `threads` threads (0 = one for each core; fewer where
/// the system gives no more). Each call may write only to data of its own taxel, so that the result does not
/// depend on their number. Where calls throw, the exception of the lowest taxel is rethrown.
void forEachTaxel(std::size_t taxels, unsigned threads, const std::function<void(std::size_t)>& work);

}  // namespace fsr::matrix
