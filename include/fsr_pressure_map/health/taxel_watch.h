#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fsr_pressure_map/map/pressure_map.h"
#include "fsr_pressure_map/matrix/layout.h"

namespace fsr::health {

/// Thresholds of TaxelWatch. Shares are relative to full scale, so that they hold for any converter.
struct TaxelWatchOptions {
  double window = 10.0;          ///< duration of a window [s]
  std::size_t least_scans = 20;  ///< a window with fewer scans is extended
  double floor_share = 0.001;    ///< readings up to here are noise of an open circuit; see setNoise()
  double loaded_share = 0.25;    ///< readings from here on are certainly a load
  double travel_share = 0.10;    ///< a change of a reading that noise cannot cause
};

/// Finds dead and stuck taxels in live scans. At the end of each window, a taxel is judged by the range of
/// its own codes and of those of its up to eight neighbours:
///
///     dead   it never rose above the floor, while more than half of its neighbours rose to loaded_share
///     stuck  it kept one code, neither floor nor full scale, while the codes of more than half of its
///            neighbours changed by travel_share; or it stayed at full scale (a short circuit) while more
///            than half of its neighbours rose to loaded_share and all of them fell below travel_share, in
///            any order
///     alive  it rose above the floor and changed
///     else   the window shows nothing, and the taxel keeps its verdict
///
/// The search for faults in recordings names taxels by the same rule (verdictOf()).
///
/// A taxel at the border of the sheet needs more: four of its five neighbours, and all three in a corner. The
/// foot of an indenter can load three of five neighbours without touching the taxel between them.
///
/// A row or column is a line fault (a broken or shorted wire) where all its taxels are dead, or all are
/// stuck, or all stay at full scale while no taxel of the neighbouring lines rose to travel_share. For the
/// outermost lines more than half of the neighbours suffice, if that holds for all their taxels.
///
/// False alarms are rare. For one, pressure would have to fall from a quarter of full scale (about 100 kPa on
/// a 620 kPa sheet, far above a turn-on pressure of 5 to 30 kPa) to nothing within one pitch on more than
/// half of a taxel's sides. Or a taxel would have to change by less than one code where most of its
/// neighbours change by 410 codes of 4,096, although the taxels of a sheet differ by a few percent only. A
/// board without noise keeps the code of a taxel at rest, so a load beside it must not be enough: gas, edges
/// and round feet raised no alarm on such a board (TaxelWatchAlarms). One remains: a load that ends between
/// the outermost line and the next one along its whole length reads like a line fault.
/// Rest, constant load and an empty matrix are no evidence and raise nothing. A whole dead row is found,
/// because its taxels have more neighbours outside the row than inside. Simulated sheets (scatter,
/// hysteresis, creep, crosstalk, noise, uneven loads) raised no false alarm in 100,000 windows of a taxel:
/// fewer than 3 in 100,000 at 95 % confidence (TaxelWatchAlarms). Not detectable are: a fault of a taxel
/// without neighbours, two dead rows side by side, and a short circuit before a load has come and gone.
///
/// A taxel at full scale whose neighbours are at rest is not yet called shorted, because a point load on one
/// taxel reads the same, and a wrong verdict would hide the highest pressure of a sheet. It is flagged
/// saturated ("at least") until a load has come to its neighbours and gone, in either order, while it stayed
/// at full scale. Point loads on a sheet at rest, even for hours, and prominences among neighbours that stay
/// loaded raise nothing (TaxelWatchAlarms). A point load that outlasts the load on all of its neighbours is
/// called a short. A whole line at full scale beside lines at rest needs no such evidence: no load is one
/// taxel wide and as long as the sheet.
///
/// A scan costs one pass over the taxels and the verdict on one row of the previous window. Nothing is
/// allocated after construction.
class TaxelWatch {
 public:
  TaxelWatch(matrix::MatrixSize size, std::uint16_t full_scale, const TaxelWatchOptions& options = {});

  /// Takes a scan: counts [rows x columns], row-major, and the time of its stamp [s]. Returns true where a
  /// verdict changed. Time that runs backwards restarts the window.
  bool observe(const std::uint16_t* counts, double time) noexcept;

  /// Deviation of a single count without load, as measured [counts]. The floor becomes five times as much, at
  /// least floor_share and at most half of travel_share: on a noisy board the noise of an open circuit is
  /// above floor_share, and a dead taxel would never be found. 0 = not known, floor_share alone.
  void setNoise(double deviation) noexcept;

  /// taxel_flag::kDead, kStuck or 0, with kLineFault where the whole line is faulty [rows x columns],
  /// row-major.
  const std::vector<std::uint16_t>& flags() const { return flags_; }

  /// How often a dead or stuck taxel became alive again.
  std::uint64_t revivals() const { return revivals_; }

 private:
  /// Smallest and largest code of each taxel within a window.
  struct Window {
    std::vector<std::uint16_t> low;
    std::vector<std::uint16_t> high;
  };
  // What a taxel's neighbours did while it stayed at full scale.
  enum Evidence : std::uint8_t { kLoadSeen = 1, kRestSeen = 2 };
  struct Neighbours {
    int count = 0;
    int needed = 0;  // number of them that is evidence against a single taxel
    int loaded = 0;
    int moved = 0;   // changed by travel_share
    int rested = 0;  // fell below travel_share
  };

  void open(double time) noexcept;
  void noteFullScale(std::size_t taxel, const Neighbours& around) noexcept;
  void widen(const std::uint16_t* counts) noexcept;
  bool judgeRow(std::uint16_t row) noexcept;
  bool judge(std::uint16_t row, std::uint16_t column) noexcept;
  /// A row or a column: `count` taxels from `first` on, `step` apart. The next line is `beside` away.
  struct Line {
    std::size_t first, count, step, beside;
    bool has_before, has_behind;
  };
  bool judgeLines() noexcept;
  bool judgeLine(const Line& line) noexcept;
  Neighbours neighbours(std::uint16_t row, std::uint16_t column) const noexcept;

  matrix::MatrixSize size_;
  std::uint16_t full_scale_;
  TaxelWatchOptions options_;
  std::uint16_t floor_;
  std::uint16_t loaded_;
  std::uint16_t travel_;
  Window current_;
  Window closed_;           // judged row by row during the next window
  std::uint16_t next_row_;  // of closed_ to judge; size_.rows = all are judged
  double start_ = 0;        // of current_ [s]
  std::size_t scans_ = 0;   // in current_
  std::vector<std::uint16_t> flags_;
  std::vector<std::uint8_t> evidence_;  // of each taxel
  std::vector<std::uint16_t> in_line_;  // verdict of each taxel that holds only with its whole line
  bool line_fault_ = false;             // flags_ has kLineFault somewhere
  std::uint64_t revivals_ = 0;
};

}  // namespace fsr::health
