// A table of readings becomes a recording with consistent sizes and finite pressures, or is refused with one
// sentence.
#include <cmath>

#include "dataset/table_recording.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "fuzz/fuzz_file.h"

namespace {

constexpr const char* kColumns[] = {
    "time=1,reading=2,reference=3",
    "time=t:ms,reading=a:V,reading=b:V,reference=p:N,temperature=k:K",
    "time=1:us,reading=2:kohm,reference=3:psi,surface=4,curvature=5:1/cm,mount=6",
    "reading=1:counts,reading=2:counts,reference=3:2500Pa",
};

void check(const fsr::dataset::Recording& recording) {
  const std::size_t scans = recording.scans();
  fuzz::require(recording.counts.size() == scans * recording.layout.size.taxels());
  fuzz::require(recording.pressure.empty() || recording.pressure.size() == scans);
  for (std::size_t i = 0; i < scans; ++i) {
    fuzz::require(std::isfinite(recording.time[i]) && recording.condition[i] < recording.conditions.size());
    fuzz::require(recording.pressure.empty() || !std::isinf(recording.pressure[i]));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  if (size == 0) return 0;
  const fuzz::MemoryFile file(bytes + 1, size - 1);
  fsr::dataset::TablePlan plan;
  plan.skip_bad_rows = bytes[0] >= 128;
  plan.curvature = bytes[0] % 2 == 0 ? std::optional<double>(0.0) : std::nullopt;
  if (bytes[0] % 3 == 0) plan.ambient_pressure = 101325;
  try {
    plan.columns = fsr::dataset::parseColumns(kColumns[bytes[0] / 2 % 4]);
    check(fsr::dataset::readTable(file.path(), plan).recording);
  } catch (const fsr::settings::InputError&) {
  }
  return 0;
}
