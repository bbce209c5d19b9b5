#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fsr_pressure_map/map/pressure_map.h"
#include "fsr_pressure_map/matrix/layout.h"

namespace fsr::health {

/// When TaxelWatch speaks. Shares are of full scale, so that they fit any converter.
struct TaxelWatchOptions {
  double window = 10.0;          ///< span of scans that is judged as one [s]
  std::size_t least_scans = 20;  ///< a window with fewer lasts on
  double floor_share = 0.001;    ///< up to here a reading is nothing: noise of an open circuit
  double loaded_share = 0.25;    ///< from here on a taxel is loaded beyond any doubt
  double travel_share = 0.10;    ///< a taxel that ranges over this much moved, whatever the noise
};

/// Finds dead and stuck taxels in live scans. A window at a time, each taxel is judged by the range
/// of its own codes beside those of its up to eight neighbours:
///
///     dead   it never rose above the floor, while more than half of its neighbours rose to
///            loaded_share and beyond
///     stuck  it kept one code, neither floor nor full scale, while more than half of its neighbours
///            ranged over travel_share and more
///            or kept full scale without a break, a short, while more than half of its neighbours rose to
///            loaded_share and all of them fell below travel_share, in whatever order
///     alive  it rose above the floor and changed
///     else   the window says nothing, and the taxel keeps the verdict it had
///
/// A row or column whose taxels are all dead, all stuck, or all at full scale from first to last scan
/// while no taxel beside the line rose to travel_share, is a line fault: a broken or shorted wire.
///
/// Why a false alarm is rare: pressure would have to go from a quarter of full scale (about 100 kPa on
/// a 620 kPa sheet, far beyond a turn-on pressure of 5 to 30 kPa) to nothing within one pitch on more
/// than half of a taxel's sides; or a taxel would have to answer with less than one code to what moves
/// most of its neighbours by 410 codes of 4,096, where a sheet's taxels differ by a few percent. Rest,
/// constant load and an empty matrix give no evidence, so they raise nothing. A whole dead row is still
/// found: its taxels have more neighbours outside than inside of it. Simulated sheets (scatter, hysteresis,
/// creep, crosstalk, noise, uneven loads) raised none in 100,000 windows of a taxel: fewer than 3 in 100,000,
/// 95 % sure (TaxelWatchAlarms). What it cannot judge: a taxel without a neighbour, two dead rows side by
/// side, a short as long as no load came and went.
///
/// A taxel at full scale whose neighbours rest is no short yet: a point load on one taxel reads the same, and
/// what hides the highest pressure of a sheet had better be sure. It is flagged saturated, "at least", until
/// load came to its neighbours, or went, while it never left full scale. Point loads on a sheet at rest, be
/// it for hours, and prominences among neighbours that stay loaded raise nothing (TaxelWatchAlarms); a point
/// load that outlasts the load on all of its neighbours does. A whole line at full scale beside lines at rest
/// needs no such proof: no load is one taxel wide and a sheet long.
///
/// The cost of a scan is one pass over the taxels and the verdict on one row of the window before;
/// nothing is allocated after construction.
class TaxelWatch {
 public:
  TaxelWatch(matrix::MatrixSize size, std::uint16_t full_scale, const TaxelWatchOptions& options = {});

  /// Takes a scan: counts [rows x columns], row-major; time of its stamp [s]. True where a verdict
  /// changed. Time that runs back starts the window anew.
  bool observe(const std::uint16_t* counts, double time) noexcept;

  /// taxel_flag::kDead, kStuck or 0, with kLineFault where a whole line is [rows x columns], row-major.
  const std::vector<std::uint16_t>& flags() const { return flags_; }

  /// How often a taxel that was dead or stuck came back to life.
  std::uint64_t revivals() const { return revivals_; }

 private:
  /// Smallest and largest code of each taxel within a window.
  struct Window {
    std::vector<std::uint16_t> low;
    std::vector<std::uint16_t> high;
  };
  // What a taxel's neighbours did while it kept full scale without a break.
  enum Evidence : std::uint8_t { kLoadSeen = 1, kRestSeen = 2 };
  struct Neighbours {
    int count = 0;
    int loaded = 0;
    int moved = 0;   // over travel_share
    int rested = 0;  // fell below travel_share
  };

  void open(double time) noexcept;
  void noteFullScale(std::size_t taxel, const Neighbours& around) noexcept;
  void widen(const std::uint16_t* counts) noexcept;
  bool judgeRow(std::uint16_t row) noexcept;
  bool judge(std::uint16_t row, std::uint16_t column) noexcept;
  bool isShort(std::size_t taxel) const noexcept { return evidence_[taxel] == (kLoadSeen | kRestSeen); }
  /// A row or a column: `count` taxels from `first` on, `step` apart; the lines beside it are `beside` apart.
  struct Line {
    std::size_t first, count, step, beside;
    bool has_before, has_behind;
  };
  bool judgeLines() noexcept;
  std::uint16_t lineVerdict(const Line& line) const noexcept;
  bool isShorted(const Line& line) const noexcept;
  bool flagLine(const Line& line) noexcept;
  Neighbours neighbours(std::uint16_t row, std::uint16_t column) const noexcept;

  matrix::MatrixSize size_;
  std::uint16_t full_scale_;
  TaxelWatchOptions options_;
  std::uint16_t floor_;
  std::uint16_t loaded_;
  std::uint16_t travel_;
  Window current_;
  Window closed_;           // judged row by row while the next one fills
  std::uint16_t next_row_;  // of closed_ to be judged; size_.rows = all are
  double start_ = 0;        // of current_ [s]
  std::size_t scans_ = 0;   // in current_
  std::vector<std::uint16_t> flags_;
  std::vector<std::uint8_t> evidence_;  // of each taxel
  bool line_fault_ = false;             // flags_ has kLineFault somewhere
  std::uint64_t revivals_ = 0;
};

}  // namespace fsr::health
