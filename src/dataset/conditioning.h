#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "fsr_pressure_map/dataset/recording.h"

namespace fsr::dataset {

/// Conditioning is four or five loadings of the sheet to 110 % of the largest pressure that is then measured,
/// before the first measurement (Tekscan, FlexiForce Sensors User Manual, "Conditioning"). It is recognised
/// with the limits of a plan's cycles: see session::Conditioning and session::Tolerance.
struct ConditioningOptions {
  double share_of_peak = 1.1;  ///< of the largest peak that follows (ratio)
  double tolerance = 0.05;     ///< by which a peak may differ from that, as a share of itself (ratio)
  std::size_t cycles = 4;      ///< fewest cycles that condition a sheet
  double night = 8;            ///< recordings with so long a pause between them are two sessions [h]
};

/// What the recordings tell about the first loadings of one session: recordings without a night between them.
struct Conditioning {
  std::string first;  ///< name of the session's first recording
  /// Cycles at its start with peaks of about 110 % of the largest later one; 0 = none.
  std::size_t cycles = 0;
  double peak = std::numeric_limits<double>::quiet_NaN();   ///< largest of these cycles, gauge [Pa]
  double later = std::numeric_limits<double>::quiet_NaN();  ///< largest afterwards, gauge [Pa]; NaN = none
  bool enough = false;                                      ///< the cycles are as many as condition a sheet
  bool said = false;   ///< an event `conditioning` was marked in the session
  bool known = false;  ///< false: no chamber pressure was recorded, and nothing was said

  bool present() const { return enough || said; }
};

/// One for each session, in the order of time. `said`: whether each recording has an event `conditioning`;
/// empty = none has.
std::vector<Conditioning> findConditioning(const std::vector<Recording>& recordings,
                                           const std::vector<bool>& said = {},
                                           const ConditioningOptions& options = {});

/// "conditioning: 5 cycles to 682 kPa seen", "conditioning: marked by an event" or "conditioning: not seen:
/// ...". With several sessions each sentence names the first recording of its session.
std::vector<std::string> conditioningSentences(const std::vector<Conditioning>& sessions);

}  // namespace fsr::dataset
