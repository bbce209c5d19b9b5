#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "blind/protocol.h"
#include "fsr_pressure_map/matrix/curvature.h"
#include "fsr_pressure_map/matrix/layout.h"

namespace blind {

/// A value for each scan of a campaign, in time order.
using Trace = std::vector<double>;

/// Scans first .. last - 1 of a campaign, while the matrix lay where it was.
struct Visit {
  std::size_t surface = 0;
  std::size_t first = 0;
  std::size_t last = 0;
  double start = 0;                   ///< campaign clock at the first scan [s]
  double pause = 0;                   ///< time without pressure before it [s]
  std::vector<double> fine_pressure;  ///< true gauge pressure each kFineStep from kLead before the first scan
};

constexpr double kFineStep = 0.02;  ///< [s]
constexpr double kLead = 5.0;       ///< [s]

/// What truly happened in the laboratory, before any sensor looked at it.
struct Campaign {
  fsr::matrix::Layout layout;
  double scan_period = 0.1;                    ///< [s]
  std::vector<fsr::matrix::Surface> surfaces;  ///< the first one flat
  std::vector<Visit> visits;
  std::size_t first_visits = 0;  ///< of the first protocol
  std::size_t first_scans = 0;   ///< likewise

  Trace time;                        ///< campaign clock [s]
  Trace pressure;                    ///< gauge [Pa]
  Trace rate;                        ///< [Pa/s]
  Trace temperature;                 ///< of the sheet [degree Celsius]
  Trace thermometer;                 ///< what a slow thermometer beside it reads [degree Celsius]
  std::vector<std::uint32_t> visit;  ///< of each scan
  std::vector<std::uint32_t> cycle;  ///< of each scan, counted through the campaign
  std::vector<std::uint32_t> cycle_of_visit;

  std::size_t scans() const { return time.size(); }
  std::size_t taxels() const { return layout.size.taxels(); }
  double curvature(std::size_t scan) const { return surfaces[visits[visit[scan]].surface].curvature[0].x; }
  /// True pressure at any time of a visit [s, campaign clock].
  double pressureAt(const Visit& at, double time_s) const;
};

/// Surfaces: flat, then cylinders from wide to tight, names as in config/surfaces.
std::vector<fsr::matrix::Surface> surfacesOf(std::size_t number);

/// One protocol after the other, on the same sheet in the same room; the first alone is the same campaign up
/// to its end.
Campaign runCampaign(const fsr::matrix::Layout& layout, const std::vector<std::string>& protocols,
                     const ProtocolSize& size, std::uint64_t seed);

}  // namespace blind
