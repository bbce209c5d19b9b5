#pragma once

#include <string>
#include <vector>

#include "emulator/task.h"

namespace fsr::emulator {

/// How a mistake changes what the operator does. Mistakes that only change numbers of the task are kNumbers.
enum class Slip {
  kNone,
  kNumbers,
  kNextSurface,
  kSwapSurfaces,
  kSurfaceBefore,
  kWrongSurfaceLater,
  kTurnedOver,
  kNoMounting,
  kNoConfirmation,
  kPressBeforeConfirming,
  kNothingDone,
  kStopHalfway,
  kPause,
  kValveOpened,
  kLeak,
  kNoUnloading,
  kTwice,
  kPressAtRest,
  kSheetOff,
  kTaxelOut,
  kBoardUnplugged,
  kTransducerUnplugged,
  kTransducerSilent,
  kTerminalClosed,
};

/// By what a mistake can be noticed during the session.
enum class Notice {
  kPressure,  ///< by the pressure, or by data that are missing
  kWaiting,   ///< nothing is wrong with the data: the session waits until it is done
  kReadings,  ///< only by comparing the readings with other mounts of the surface
};

/// A mistake that an operator can make.
struct Mistake {
  std::string name;
  std::string description;  ///< what the operator does
  Notice notice = Notice::kPressure;
  /// Reasons, separated by spaces: a good conductor names one of them, as a hint or when it rejects the
  /// attempt. Empty for kWaiting.
  std::string expected;
  Slip slip = Slip::kNumbers;
  bool (*suits)(const Task&) = nullptr;  ///< tasks in which it can be made
  void (*change)(Task&) = nullptr;       ///< for kNumbers: changes the numbers of the task
};

/// All mistakes.
const std::vector<Mistake>& mistakes();
/// Throws InputError that lists the names where there is none of that name.
const Mistake& mistakeCalled(const std::string& name);

/// A mistake in a script. It is made once, in the first task from `step` on that it suits.
struct ScriptedMistake {
  std::string name;
  std::uint32_t step = 0;
};

/// Reads "peak_too_low@5,board_unplugged@9". Without "@" the step is 0. Throws InputError.
std::vector<ScriptedMistake> readMistakes(const std::string& script);

}  // namespace fsr::emulator
