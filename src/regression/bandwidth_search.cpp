#include "regression/bandwidth_search.h"

#include <cmath>
#include <utility>

namespace fsr::regression {

void TestedCodes::add(const CodeStatistics& readings) {
  readings.forEach([&](const CodeSums& sums) {
    const Int128 spread = sums.sum_of_squares * sums.count - Int128{sums.sum} * sums.sum;
    code_.push_back(sums.code);
    count_.push_back(sums.count);
    mean_.push_back(fromFixed(sums.sum) / sums.count);
    scatter_ += static_cast<double>(spread) / sums.count * kFixedPressureUnit * kFixedPressureUnit;
    readings_ += sums.count;
  });
}

double TestedCodes::squares(const std::vector<double>& pressure) const {
  double sum = scatter_;
  for (std::size_t i = 0; i < code_.size(); ++i) {
    const double error = pressure[code_[i]] - mean_[i];
    sum += count_[i] * error * error;
  }
  return sum;
}

std::vector<double> bandwidthGrid() {
  std::vector<double> grid;
  for (int power = -10; power <= 1; ++power) grid.push_back(std::ldexp(1.0, power));
  return grid;
}

BandwidthErrors::BandwidthErrors(const std::vector<CodeStatistics>& sections, std::uint16_t full_scale,
                                 const GrnnOptions& options, const std::vector<double>& grid)
    : grid_(grid), sections_(sections.size()), squares_(grid.size() * sections_ * sections_, 0.0) {
  CodeHistogram training(full_scale);
  std::vector<TestedCodes> tested;
  for (const CodeStatistics& section : sections) {
    training.add(section);
    tested.emplace_back().add(section);
  }
  std::vector<Grnn> models;
  for (const double bandwidth : grid) {
    GrnnOptions with_bandwidth = options;
    with_bandwidth.bandwidth = bandwidth;
    models.emplace_back(with_bandwidth);
  }
  for (std::size_t a = 0; a < sections_; ++a) {
    training.subtract(sections[a]);
    for (std::size_t b = a; b < sections_; ++b) {
      if (b != a) training.subtract(sections[b]);
      for (std::size_t g = 0; g < grid.size() && training.samples() > 0; ++g) {
        const std::vector<double> pressure = models[g].fit(training).pressure;
        at(g, a, b) = tested[a].squares(pressure);
        at(g, b, a) = tested[b].squares(pressure);
      }
      if (b != a) training.add(sections[b]);
    }
    training.add(sections[a]);
  }
}

double& BandwidthErrors::at(std::size_t bandwidth, std::size_t tested, std::size_t left_out) {
  return squares_[(bandwidth * sections_ + tested) * sections_ + left_out];
}

void BandwidthErrors::add(const BandwidthErrors& other) {
  for (std::size_t i = 0; i < squares_.size(); ++i) squares_[i] += other.squares_[i];
}

double BandwidthErrors::squares(std::size_t bandwidth, std::size_t left_out) const {
  double sum = 0;
  for (std::size_t tested = 0; tested < sections_; ++tested) {
    if (tested == left_out) continue;
    const std::size_t other = left_out == kNoneLeftOut ? tested : left_out;
    sum += squares_[(bandwidth * sections_ + tested) * sections_ + other];
  }
  return sum;
}

double BandwidthErrors::best(std::size_t left_out) const {
  double least = INFINITY, bandwidth = kPaperBandwidth;
  bool any = false;
  for (std::size_t g = 0; g < grid_.size(); ++g) {
    const double sum = squares(g, left_out);
    any = any || sum > 0;
    if (sum < least || (sum == least && grid_[g] > bandwidth)) {
      least = sum;
      bandwidth = grid_[g];
    }
  }
  return any ? bandwidth : kPaperBandwidth;
}

}  // namespace fsr::regression
