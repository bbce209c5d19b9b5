#include "blind/signature.h"

#include <algorithm>
#include <cmath>

namespace blind {

namespace {

constexpr double kStanding = 1e3;  // below this rate the pressure counts as constant [Pa/s]

}  // namespace

double Signature::Squares::rms() const {
  return number > 0 ? std::sqrt(sum / number) : 0;
}

Signature::Signature(const Campaign& campaign) : campaign_(campaign) {}

void Signature::add(std::size_t taxel, const Trace& residual) {
  const std::size_t bins = static_cast<std::size_t>(2 * kPeak / kBin);
  std::vector<Squares> surface(campaign_.surfaces.size()), bin(bins);
  const auto count = [](Squares& squares, double square) {
    squares.sum += square;
    squares.number += 1;
  };
  for (std::size_t scan = 0; scan < residual.size(); ++scan) {
    const double square = residual[scan] * residual[scan];
    count(surface[campaign_.visits[campaign_.visit[scan]].surface], square);
    count(bin[static_cast<std::size_t>(std::max(0.0, campaign_.pressure[scan]) / kBin)], square);
    if (campaign_.rate[scan] > kStanding) count(loading_, square);
    if (campaign_.rate[scan] < -kStanding) count(unloading_, square);
    count(by_taxel_[taxel], square);
    count(all_, square);
  }
  const auto merge = [](Table& table, const std::vector<Squares>& part) {
    for (std::size_t i = 0; i < part.size(); ++i) {
      if (part[i].number == 0) continue;
      table[i].sum += part[i].sum;
      table[i].number += part[i].number;
    }
  };
  merge(by_surface_, surface);
  merge(by_bin_, bin);
}

double Signature::rms() const {
  return all_.rms();
}

std::vector<std::size_t> Signature::above(const Table& table, double share) {
  double largest = 0;
  for (const auto& [member, squares] : table) largest = std::max(largest, squares.rms());
  std::vector<std::size_t> members;
  for (const auto& [member, squares] : table) {
    if (largest > 0 && squares.rms() >= share * largest) members.push_back(member);
  }
  return members;
}

std::vector<std::size_t> Signature::taxels() const {
  return above(by_taxel_, kShare);
}

std::vector<std::size_t> Signature::surfaces() const {
  return above(by_surface_, kShare);
}

std::pair<double, double> Signature::pressures() const {
  const std::vector<std::size_t> bins = above(by_bin_, kPressureShare);
  if (bins.empty()) return {0, 0};
  const double high = kBin * static_cast<double>(bins.back() + 1);
  return {kBin * static_cast<double>(bins.front()), std::min(high, kPeak)};
}

std::string Signature::direction() const {
  const double total = loading_.sum + unloading_.sum;
  if (loading_.sum < kDirectionShare * total) return "unloading";
  if (unloading_.sum < kDirectionShare * total) return "loading";
  return "both";
}

}  // namespace blind
