#include "fsr_pressure_map/dataset/recording.h"

namespace fsr::dataset {

namespace {

// A bag begins and ends between two chamber readings, so a few such scans are normal.
constexpr std::uint64_t kScansAtTheEnds = 10;

std::string scans(std::uint64_t number) {
  return std::to_string(number) + (number == 1 ? " scan" : " scans");
}

}  // namespace

std::vector<std::string> describeLosses(const RecordingLosses& losses) {
  std::vector<std::string> sentences;
  if (losses.counter_back > 0) {
    sentences.push_back("the board's counter ran backwards " + std::to_string(losses.counter_back) +
                        (losses.counter_back == 1 ? " time" : " times") +
                        ": the board started again, or stamps ran backwards and were sorted");
  }
  if (losses.sequence_gaps > 0) {
    sentences.push_back(std::to_string(losses.sequence_gaps) +
                        (losses.sequence_gaps == 1 ? " gap" : " gaps") + " between scans, " +
                        scans(losses.lost_scans) + " lost by the board's counter");
  }
  if (losses.duplicates > 0) {
    sentences.push_back("dropped " + scans(losses.duplicates) + " with the stamp of another one");
  }
  if (losses.near_change > 0) {
    sentences.push_back("dropped " + scans(losses.near_change) + " within 1 s of a change of surface");
  }
  if (losses.no_reference > kScansAtTheEnds) {
    sentences.push_back("dropped " + scans(losses.no_reference) + " in gaps of chamber_pressure");
  }
  if (losses.bad_reference > 0) {
    sentences.push_back("left out " + std::to_string(losses.bad_reference) +
                        " chamber pressures that are not finite");
  }
  if (losses.reference_spikes > 0) {
    sentences.push_back("left out " + std::to_string(losses.reference_spikes) +
                        " chamber pressures that jump away and back while the sheet feels nothing");
  }
  if (losses.unknown_surface > 0) {
    sentences.push_back("dropped " + scans(losses.unknown_surface) + " on a surface of unknown curvature");
  }
  return sentences;
}

}  // namespace fsr::dataset
