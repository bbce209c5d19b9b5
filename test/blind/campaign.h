#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "blind/protocol.h"
#include "blind/rig_plan.h"
#include "fsr_pressure_map/matrix/curvature.h"
#include "fsr_pressure_map/matrix/layout.h"

namespace blind {

/// One value for each scan of a campaign, in time order.
using Trace = std::vector<double>;

/// One stay of the matrix on a surface: scans first .. last - 1 of a campaign.
struct Visit {
  std::size_t surface = 0;
  std::size_t first = 0;
  std::size_t last = 0;
  double start = 0;  ///< campaign clock at the first scan [s]
  double pause = 0;  ///< time without pressure before the visit [s]
  /// True gauge pressure [Pa] in steps of Campaign::fine_step, beginning kLead before the first scan.
  std::vector<double> fine_pressure;
};

constexpr double kLead = 5.0;  ///< [s]

/// The true course of events in the laboratory, before any sensor. Pressures are reduced: kPeak stands for
/// the highest pressure of the protocol, so sheets and effects are those of a sensor made for that range.
struct Campaign {
  fsr::matrix::Layout layout;
  double scan_period = 0.1;                    ///< [s]
  double fine_step = 0.02;                     ///< [s]
  double pascal = 1;                           ///< true pressure by reduced pressure
  std::vector<fsr::matrix::Surface> surfaces;  ///< the first one is flat
  std::vector<Visit> visits;
  std::size_t first_visits = 0;  ///< number of visits of the first protocol
  std::size_t first_scans = 0;   ///< number of scans of the first protocol

  Trace time;                        ///< campaign clock [s]
  Trace pressure;                    ///< gauge, reduced [Pa]
  Trace rate;                        ///< [Pa/s]
  Trace temperature;                 ///< temperature of the sheet [degree Celsius]
  Trace thermometer;                 ///< reading of a slow thermometer beside the sheet [degree Celsius]
  std::vector<std::uint32_t> visit;  ///< visit of each scan
  std::vector<std::uint32_t> cycle;  ///< cycle of each scan, counted through the campaign
  std::vector<std::uint32_t> cycle_of_visit;

  std::size_t scans() const { return time.size(); }
  std::size_t taxels() const { return layout.size.taxels(); }
  double ambient() const { return 101325 / pascal; }  ///< absolute, reduced [Pa]
  double curvature(std::size_t scan) const { return surfaces[visits[visit[scan]].surface].curvature[0].x; }
  /// True pressure at any time of a visit [s, campaign clock].
  double pressureAt(const Visit& at, double time_s) const;
};

/// Surfaces: flat, then cylinders from the largest radius to the smallest, named as in config/surfaces.
std::vector<fsr::matrix::Surface> surfacesOf(std::size_t number);

/// Runs one protocol after the other, on the same sheet in the same room. The part of the first protocol is
/// the same whether others follow or not.
Campaign runCampaign(const fsr::matrix::Layout& layout, const std::vector<std::string>& protocols,
                     const ProtocolSize& size, std::uint64_t seed);

/// Runs a drawn plan; climate and scan period come from the seed.
Campaign runCampaign(const RigPlan& plan, std::uint64_t seed);

}  // namespace blind
