#include "fsr_pressure_map/dataset/recording.h"

namespace fsr {

std::vector<std::string> describeLosses(const RecordingLosses& losses) {
  std::vector<std::string> sentences;
  const auto say = [&sentences](std::uint64_t number, const std::string& what) {
    if (number > 0) sentences.push_back(std::to_string(number) + what);
  };
  say(losses.lost_scans,
      " scans are missing in " + std::to_string(losses.sequence_gaps) + " gaps of the board's counter");
  say(losses.duplicates, " scans had the stamp of another one and were dropped");
  say(losses.no_reference, " scans lie in a gap of chamber_pressure and were dropped");
  say(losses.bad_reference, " chamber pressures were no number and were left out");
  say(losses.unknown_surface, " scans were made on a surface of unknown curvature and were dropped");
  return sentences;
}

}  // namespace fsr
