#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "calibration/stages/memory/history_training.h"
#include "calibration/stages/session/session_rests.h"
#include "calibration/stages/tables/training_scans.h"
#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr::calibration {

/// How the readings of a session are predicted.
enum class SessionAnswer {
  kPlain,  ///< by the static tables
  kTared,  ///< by the same tables after a tare at the start of the session
  kZeroed  ///< by tables that were trained with the zero of each session, after a tare
};
constexpr std::size_t kSessionAnswers = 3;

/// Errors of one session, by SessionAnswer.
struct SessionErrors {
  double readings = 0;
  std::array<double, kSessionAnswers> squares = {};  // [Pa^2]
};

/// Tables of one taxel that are trained with the zeros of its sessions: a table is trained on the chamber
/// pressure plus the zeros, and the zeros are what it answers too much at rest. The zeros of the sessions
/// behind one table have the mean 0, so that the table stays where it was.
class SessionTables {
 public:
  /// The arguments must outlive the object. `scans`: the section of a scan is the number of its session.
  SessionTables(const HistoryProblem& problem, const Sessions& sessions, const TrainingScans& scans,
                std::uint16_t full_scale, std::size_t taxel);

  /// [sessions], each predicted without the session; those that are not assessable are empty.
  std::vector<SessionErrors> leaveEachOut() const;
  /// [sessions], from all sessions.
  std::vector<regression::FixedPressure> zeros() const;

 private:
  using Zeros = std::vector<regression::FixedPressure>;  // [sessions]
  using Tables = std::vector<std::vector<double>>;       // [classes][codes] [Pa]; empty = no answer

  bool leftOut(const Session& session, std::optional<std::uint32_t> number) const;
  /// The readings of the sessions that are not left out, each larger by the zero of its session.
  regression::ClassReadings readingsWithout(std::optional<std::uint32_t> left_out, const Zeros& zeros) const;
  /// Adds `step` to the readings of a session, which are larger by `zero`.
  void move(std::size_t session, regression::FixedPressure zero, regression::FixedPressure step,
            regression::ClassReadings& readings) const;
  Tables fit(const regression::ClassReadings& readings) const;
  Tables train(std::optional<std::uint32_t> left_out, const Zeros& zeros) const;
  /// What the tables answer too much at the rest of a session.
  std::optional<double> zeroOf(std::size_t session, const Tables& tables) const;
  double zeroInTraining(std::optional<std::uint32_t> left_out, std::size_t model, const Tables& tables) const;
  std::vector<std::vector<std::size_t>> trainedSessions(std::optional<std::uint32_t> left_out) const;
  /// `tables`: with `zeros`.
  void improve(std::optional<std::uint32_t> left_out, const Tables& tables, Zeros& zeros) const;
  Tables responseTo(const std::vector<std::size_t>& moved, std::optional<std::uint32_t> left_out,
                    const Zeros& zeros, regression::ClassReadings& readings) const;
  /// `tables`: first without zeros, then with the zeros returned.
  Zeros solve(std::optional<std::uint32_t> left_out, Tables& tables) const;
  void addErrors(std::size_t number, const Tables& plain, const Tables& zeroed, SessionErrors& errors) const;
  std::array<std::uint16_t, 2> codesWithout(const Session& session) const;

  const HistoryProblem& problem_;
  const Sessions& sessions_;
  std::size_t taxel_;
  compensation::SectionedReadings readings_;       // the sections are the sessions
  std::vector<std::vector<ReadingAtRest>> rests_;  // [sessions]
};

/// Chooses whether the calibration expects a tare at the start of a session, see SessionZero. Each session in
/// turn is predicted by tables that were trained without it, with the zero of its own rest. `calibration`
/// must have the taxels without a model; it receives the choice and its scores. Returns the zeros to train
/// the tables with, empty where they are trained as without a tare. Throws InputError if a tare is asked for
/// and no session starts at rest.
///
/// A tare is expected if it is better by 2 % over all readings with p < 0.05 (Student's paired t test over
/// the sessions, one-sided); also where the sessions cannot tell. It is not where it is worse by 1 % or
/// beyond chance, and where the 95 % interval of its gain ends below 2 %.
SessionZeros chooseSessionZero(const HistoryProblem& problem, const Sessions& sessions,
                               const CalibrationOptions& options, Calibration& calibration);

/// SessionZero::at_rest, for the tables of `calibration`. The rests must be referred to the training.
void rememberRests(const Sessions& sessions, Calibration& calibration);

}  // namespace fsr::calibration
