#include "dataset/conditioning.h"

#include <algorithm>
#include <cmath>

#include "dataset/sections.h"
#include "settings/number_text.h"

namespace fsr::dataset {

namespace {

constexpr const char* kWhyItMatters = "the first loadings of a sheet differ from later ones";

double beginsAt(const Recording& recording) {
  return 1e-9 * static_cast<double>(recording.start_ns);
}  // [s]
double endsAt(const Recording& recording) {
  return beginsAt(recording) + (recording.time.empty() ? 0 : recording.time.back());
}

// Indices of the recordings of each session.
std::vector<std::vector<std::size_t>> sessionsOf(const std::vector<Recording>& recordings, double night) {
  std::vector<std::vector<std::size_t>> sessions;
  double end = 0;  // of the session so far [s]
  for (const std::size_t r : inOrderOfTime(recordings)) {
    if (sessions.empty() || beginsAt(recordings[r]) - end >= 3600 * night) {
      sessions.emplace_back();
      end = endsAt(recordings[r]);
    }
    sessions.back().push_back(r);
    end = std::max(end, endsAt(recordings[r]));
  }
  return sessions;
}

// Adds the largest pressure of each cycle [Pa].
void addPeaks(const Recording& recording, std::vector<double>& peaks) {
  std::vector<double> pressure;
  for (const double value : recording.pressure) {
    if (std::isfinite(value)) pressure.push_back(value);
  }
  const Cycles cycles = findCycles(pressure);
  for (std::size_t c = 0; c < cycles.count(); ++c) {
    const auto from = pressure.begin() + static_cast<std::ptrdiff_t>(cycles.first[c]);
    const auto to = c + 1 < cycles.count()
                        ? pressure.begin() + static_cast<std::ptrdiff_t>(cycles.first[c + 1])
                        : pressure.end();
    peaks.push_back(*std::max_element(from, to));
  }
}

// The longest run of first cycles with peaks of about `share_of_peak` of the largest later one.
void findRun(const std::vector<double>& peaks, const ConditioningOptions& options, Conditioning& found) {
  if (peaks.empty()) return;
  found.known = true;
  found.later = *std::max_element(peaks.begin(), peaks.end());
  double later = 0;
  for (std::size_t n = peaks.size() - 1; n > 0; --n) {
    later = std::max(later, peaks[n]);
    const auto end = peaks.begin() + static_cast<std::ptrdiff_t>(n);
    const auto [low, high] = std::minmax_element(peaks.begin(), end);
    const double wanted = options.share_of_peak * later;
    if (*low < (1 - options.tolerance) * wanted || *high > (1 + options.tolerance) * wanted) continue;
    found.cycles = n;
    found.peak = *high;
    found.later = later;
    found.enough = n >= options.cycles;
    return;
  }
}

std::string cyclesText(const Conditioning& session) {
  return std::to_string(session.cycles) + (session.cycles == 1 ? " cycle to " : " cycles to ") +
         settings::fixedPressure(session.peak, 0) + " seen";
}

std::string whatWasSeen(const Conditioning& session) {
  if (session.enough) return cyclesText(session);
  if (session.said) return "marked by an event";
  if (!session.known)
    return std::string("not known, because no cycle of the chamber was recorded: ") + kWhyItMatters;
  if (session.cycles > 0) return cyclesText(session) + ", fewer than four: " + kWhyItMatters;
  const ConditioningOptions usual;
  return std::string("not seen: ") + kWhyItMatters + " (four or five cycles to " +
         settings::fixedPressure(usual.share_of_peak * session.later, 0) +
         " before the first recording, recorded or marked with the event \"conditioning\")";
}

}  // namespace

std::vector<Conditioning> findConditioning(const std::vector<Recording>& recordings,
                                           const std::vector<bool>& said,
                                           const ConditioningOptions& options) {
  std::vector<Conditioning> all;
  for (const std::vector<std::size_t>& session : sessionsOf(recordings, options.night)) {
    Conditioning found;
    found.first = recordings[session.front()].name;
    std::vector<double> peaks;
    for (const std::size_t r : session) {
      addPeaks(recordings[r], peaks);
      found.said = found.said || (r < said.size() && said[r]);
    }
    findRun(peaks, options, found);
    found.known = found.known || found.said;
    all.push_back(found);
  }
  return all;
}

std::vector<std::string> conditioningSentences(const std::vector<Conditioning>& sessions) {
  std::vector<std::string> sentences;
  for (const Conditioning& session : sessions) {
    const std::string which = sessions.size() > 1 ? " before " + session.first : "";
    sentences.push_back("conditioning" + which + ": " + whatWasSeen(session));
  }
  return sentences;
}

}  // namespace fsr::dataset
