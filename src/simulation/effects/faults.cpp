#include "simulation/effects/faults.h"

#include <algorithm>
#include <cmath>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::simulation {

namespace {

// A taxel, row or column by the seed.
std::size_t picked(const statistics::RandomStream& stream, std::uint64_t position, std::size_t choices) {
  return static_cast<std::size_t>(stream.uniform(position) * static_cast<double>(choices));
}

void requireWhole(const std::string& id, const std::string& parameter, double value, double low,
                  double high) {
  if (value == std::floor(value) && value >= low && value <= high) return;
  throw settings::InputError("effects." + id + ": " + parameter + " is " + std::to_string(value) +
                             ", but must be a whole number, " + settings::Range{low, high}.text());
}

}  // namespace

std::vector<EffectParameter> faultyTaxelParameters() {
  return {
      strength("taxels", "how many", {0, 4096, "taxels"}, 1).within(1, 4096),
      shape("first", "index of the first one, row-major; -1 = by the seed", {-1, 4095, ""}, -1),
      shape("start", "when the fault begins", {0, 1e9, "s"}, 0),
  };
}

std::vector<std::size_t> faultyTaxels(const std::string& id, const EffectValues& values,
                                      const EffectContext& context) {
  const std::size_t taxels = context.layout.size.taxels();
  const double count = values.at("taxels"), first = values.at("first");
  requireWhole(id, "taxels", count, 0, static_cast<double>(taxels));
  requireWhole(id, "first", first, -1, static_cast<double>(taxels) - 1);
  const statistics::RandomStream stream = statistics::randomStream(context.seed, id);
  std::vector<std::size_t> faulty;
  if (first >= 0 && count > 0) faulty.push_back(static_cast<std::size_t>(first));
  for (std::uint64_t draw = 0; static_cast<double>(faulty.size()) < count; ++draw) {
    const std::size_t taxel = picked(stream, draw, taxels);
    if (std::find(faulty.begin(), faulty.end(), taxel) == faulty.end()) faulty.push_back(taxel);
  }
  return faulty;
}

std::vector<EffectParameter> looseLineParameters(const std::string& line) {
  return {
      strength("share", "share of time without contact", {0, 1, ""}, 0.05).within(1e-4, 1),
      shape("line", "which " + line + "; -1 = by the seed", {-1, matrix::kMaxMatrixSide - 1, ""}, -1),
      shape("burst", "length of a burst", {1e-3, 3600, "s"}, 0.5),
      shape("depth", "share of the conductance that is lost in a burst", {0, 1, ""}, 1),
  };
}

LooseLine::LooseLine(const std::string& id, std::size_t lines, const EffectValues& values,
                     const EffectContext& context)
    : share_(values.at("share")),
      burst_(values.at("burst")),
      depth_(values.at("depth")),
      stream_(statistics::randomStream(context.seed, id)) {
  const double line = values.at("line");
  requireWhole(id, "line", line, -1, static_cast<double>(lines) - 1);
  line_ = line < 0 ? picked(statistics::randomStream(context.seed, id + ".line"), 0, lines)
                   : static_cast<std::size_t>(line);
}

double LooseLine::contact(double time) const {
  const auto piece = static_cast<std::uint64_t>(std::floor(std::max(time, 0.0) / burst_));
  return stream_.uniform(piece) < share_ ? 1 - depth_ : 1;
}

}  // namespace fsr::simulation
