#pragma once

#include "discrepancy/samples/measured.h"

namespace fsr::discrepancy {

/// Throws InputError where the reference of a recording does not belong to its readings: they change while it
/// stays, fall where it rises, or do not follow it. Such a recording would make a static curve of its own,
/// and nothing would be noticed.
void requireReference(const Measured& measured);

}  // namespace fsr::discrepancy
