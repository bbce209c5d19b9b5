#pragma once

#include <functional>
#include <string>
#include <vector>

#include "emulator/operator.h"
#include "fsr_pressure_map/matrix/curvature.h"

namespace test_support {

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
  Notice notice = Notice::kPressure;
  /// Reasons, separated by spaces: a good conductor names one of them, as a hint or when it rejects the
  /// attempt. Empty for kWaiting.
  std::string expected;
  Slip slip = Slip::kNumbers;
  bool (*suits)(const fsr::emulator::Task&) = nullptr;  ///< tasks in which it can be made
  void (*change)(fsr::emulator::Task&) = nullptr;       ///< for kNumbers: changes the numbers of the task
};

const std::vector<Mistake>& mistakes();
/// Throws std::out_of_range where there is none of that name.
const Mistake& mistakeCalled(const std::string& name);

struct ClumsyOptions {
  fsr::emulator::OperatorOptions person;
  /// "peak_too_low@5,board_unplugged@9": each mistake is made once, in the first task from that step on that
  /// it suits; the next attempt is without it.
  std::string script;
  std::vector<std::string> shelf;  ///< names of the surfaces beside the rig, in their order
  /// Surface of a name; needed by turned_over.
  std::function<fsr::matrix::Surface(const std::string&)> surface_called;
  double repair = 30;  ///< until something unplugged is noticed unasked [s]
};

/// A mistake that was made.
struct MadeMistake {
  std::string name;
  std::uint32_t step = 0;  ///< of the task in which it was made
  double time = 0;         ///< at which that task was begun [s rig time]
};

/// "close the terminal of the conductor": an act that changes nothing of the rig.
extern const char kCloseTerminal[];

/// An operator who makes scripted mistakes. At a new remark the operator plugs in what is unplugged, presses
/// the connector of the sheet down, and confirms what was forgotten. At the next attempt a sheet that has
/// slipped off is put on again, and also one on a wrong surface if the remark has the word "surface" or
/// "sheet".
class ClumsyOperator : public fsr::emulator::Operator {
 public:
  explicit ClumsyOperator(const ClumsyOptions& options);

  const std::vector<MadeMistake>& made() const { return made_; }
  /// Names of the scripted mistakes that no task has suited so far.
  std::vector<std::string> pending() const;

 protected:
  using Task = fsr::emulator::Task;
  void prepare(double time, const Task& task) override;
  void hear(double time, const Task& task) override;
  void carryOut(Task task) override;
  void mount(const Task& task) override;
  void press(const Task& task) override;
  void fill(const Task& task) override;
  void hold(const Task& task) override;
  void rest(const Task& task) override;

 private:
  struct Scripted {
    Mistake mistake;
    std::uint32_t step;
    bool used;
  };
  using Change = std::function<void(fsr::emulator::Board&, fsr::emulator::LineDamage&, double)>;
  void handle(double half_way);
  void repair(double time);
  void does(double time, const std::string& words, const Change& change, bool stays = false);
  void putOnTurnedOver(const std::string& surface);
  std::string nextOnShelf(const std::string& surface) const;

  ClumsyOptions clumsy_;
  std::vector<Scripted> script_;
  std::vector<MadeMistake> made_;
  Slip slip_ = Slip::kNone;  // of the present task
  bool turned_over_ = false, taxel_out_ = false;
  std::string swapped_;  // surface to be used at the next mount; empty = the right one
};

}  // namespace test_support
