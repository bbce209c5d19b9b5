#include "study/scan_list.h"

#include <algorithm>

namespace fsr::study {

void ScanList::add(const ScanRun& run) {
  const bool goes_on =
      !runs_.empty() && runs_.back().recording == run.recording && runs_.back().end == run.begin;
  if (goes_on)
    runs_.back().end = run.end;
  else
    runs_.push_back(run);
  scans_ += run.scans();
}

ScanList ScanList::picked(const std::vector<std::uint32_t>& places) const {
  ScanList picked;
  auto run = runs_.begin();
  std::size_t before = 0;  // scans of the list before the run
  for (const std::uint32_t place : places) {
    while (place >= before + run->scans()) before += (run++)->scans();
    picked.add(ScanPlace{run->recording, static_cast<std::uint32_t>(run->begin + (place - before))});
  }
  return picked;
}

bool operator==(const ScanList& a, const ScanList& b) {
  return std::equal(a.runs().begin(), a.runs().end(), b.runs().begin(), b.runs().end(),
                    [](const ScanRun& one, const ScanRun& other) {
                      return one.recording == other.recording && one.begin == other.begin &&
                             one.end == other.end;
                    });
}

}  // namespace fsr::study
