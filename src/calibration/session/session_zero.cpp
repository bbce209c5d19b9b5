#include "calibration/session/session_zero.h"

#include <algorithm>
#include <cmath>

#include "calibration/held_out_scoring.h"
#include "calibration/session/session_tables.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "matrix/for_each_taxel.h"

namespace fsr::calibration {

namespace {

// Tables of today are kept if tables with zeros are better by no more than this in root mean square.
constexpr double kAsGood = 1.01;

constexpr char kWhatToRecord[] =
    "record a surface in two sessions or more, each starting with 2 s at rest at the lowest pressure";

// Sum over the sessions, each with the same weight [Pa^2].
double squareOf(const std::vector<SessionScore::Session>& sessions, SessionAnswer answer) {
  double sum = 0;
  for (const SessionScore::Session& session : sessions) {
    const double rmse = session.rmse[std::size_t(answer)];
    sum += rmse * rmse;
  }
  return sum;
}

double rmseOf(const std::vector<SessionScore::Session>& sessions, SessionAnswer answer) {
  return std::sqrt(squareOf(sessions, answer) / static_cast<double>(sessions.size()));
}

bool nowhereWorse(const std::vector<SessionScore::Session>& sessions, SessionAnswer answer) {
  return std::all_of(sessions.begin(), sessions.end(), [&](const SessionScore::Session& session) {
    return session.rmse[std::size_t(answer)] <= kWorse * session.rmse[0];
  });
}

bool wins(const std::vector<SessionScore::Session>& sessions, SessionAnswer answer) {
  return nowhereWorse(sessions, answer) &&
         rmseOf(sessions, answer) <= kWins * rmseOf(sessions, SessionAnswer::kPlain);
}

// The better of the two ways to use a tare; the simpler one if it is as good.
SessionAnswer better(const std::vector<SessionScore::Session>& sessions) {
  return rmseOf(sessions, SessionAnswer::kTared) <= kAsGood * rmseOf(sessions, SessionAnswer::kZeroed)
             ? SessionAnswer::kTared
             : SessionAnswer::kZeroed;
}

std::string wayText(SessionAnswer answer) {
  return answer == SessionAnswer::kTared
             ? ", with the tables as without it, which are as good as tables trained with the zeros"
             : ", with tables that are trained with the zero of each session";
}

std::string reasonForNone(const std::vector<SessionScore::Session>& sessions) {
  const double allowed = kWins * rmseOf(sessions, SessionAnswer::kPlain);
  const bool better_somehow = rmseOf(sessions, SessionAnswer::kTared) <= allowed ||
                              rmseOf(sessions, SessionAnswer::kZeroed) <= allowed;
  return better_somehow ? "since with it a session that was left out is worse by more than 1 %"
                        : "since it is not better by 2 % on sessions that were left out";
}

SessionAnswer choose(ZeroChoice choice, SessionScore& score) {
  const auto& sessions = score.sessions;
  const SessionAnswer best = better(sessions);
  if (choice == ZeroChoice::kSession) {
    score.choice = std::string("Tare at the start of a session: expected, as asked for") +
                   (wins(sessions, best) ? "" : ", although it does not win on sessions that were left out") +
                   wayText(best) + ".";
    return best;
  }
  for (const SessionAnswer answer : {best, SessionAnswer::kTared, SessionAnswer::kZeroed}) {
    if (!wins(sessions, answer)) continue;
    score.choice = "Tare at the start of a session: expected, since it wins on sessions that were left out" +
                   (answer == best ? wayText(answer) : std::string()) + ".";
    return answer;
  }
  score.choice = "Tare at the start of a session: not expected, " + reasonForNone(sessions) + ".";
  return SessionAnswer::kPlain;
}

std::string countText(std::size_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

// No session can be left out.
void refuse(const Sessions& sessions, ZeroChoice choice, Calibration& calibration) {
  const auto resting =
      static_cast<std::size_t>(std::count_if(sessions.all.begin(), sessions.all.end(),
                                             [](const Session& session) { return !session.rest.empty(); }));
  const std::string reason = "no surface has two sessions that start at rest (" +
                             countText(sessions.all.size(), "session") + ", " + std::to_string(resting) +
                             " of them with a rest at the start); " + kWhatToRecord;
  if (choice == ZeroChoice::kSession) throw settings::InputError("zero session: " + reason);
  calibration.scores.session.choice = "Tare at the start of a session: not expected, since " + reason + ".";
}

// Work on all taxels that have a model.
class SessionTraining {
 public:
  SessionTraining(const HistoryProblem& problem, const Sessions& sessions, unsigned threads,
                  const Calibration& calibration)
      : problem_(problem), sessions_(sessions), threads_(threads), calibration_(calibration) {
    std::vector<dataset::Sections> by_session = problem.sections;
    for (const Session& session : sessions.all) {
      const dataset::Recording& recording = problem.recordings[session.recording];
      std::vector<std::uint32_t>& section = by_session[session.recording].section;
      for (std::size_t i = 0; i < section.size(); ++i) {
        if (section[i] != dataset::kNoSection && recording.condition[i] == session.condition)
          section[i] = session.number;
      }
    }
    scans_ = gatherScans(problem.recordings, problem.classes, by_session, {});
  }

  std::vector<SessionScore::Session> score() const;
  SessionZeros zeros() const;

 private:
  template <typename Work>
  void forEachModelledTaxel(Work&& work) const {
    const std::uint16_t full_scale = problem_.recordings.front().full_scale;
    matrix::forEachTaxel(calibration_.no_model.size(), threads_, [&](std::size_t taxel) {
      if (calibration_.no_model[taxel] == 0)
        work(taxel, SessionTables(problem_, sessions_, scans_, full_scale, taxel));
    });
  }

  const HistoryProblem& problem_;
  const Sessions& sessions_;
  unsigned threads_;
  const Calibration& calibration_;
  TrainingScans scans_;  // the section of a scan is its session
};

std::vector<SessionScore::Session> SessionTraining::score() const {
  std::vector<std::vector<SessionErrors>> each(calibration_.no_model.size());
  forEachModelledTaxel(
      [&](std::size_t taxel, const SessionTables& tables) { each[taxel] = tables.leaveEachOut(); });
  std::vector<SessionErrors> all(sessions_.all.size());
  for (const std::vector<SessionErrors>& own : each) {
    for (std::size_t s = 0; s < own.size(); ++s) {
      all[s].readings += own[s].readings;
      for (std::size_t a = 0; a < kSessionAnswers; ++a) all[s].squares[a] += own[s].squares[a];
    }
  }
  std::vector<SessionScore::Session> scores;
  for (std::size_t s = 0; s < all.size(); ++s) {
    if (!(all[s].readings > 0)) continue;
    SessionScore::Session& score = scores.emplace_back();
    score.name = sessions_.all[s].name(problem_.recordings);
    score.readings = static_cast<std::uint64_t>(all[s].readings);
    for (std::size_t a = 0; a < kSessionAnswers; ++a)
      score.rmse[a] = std::sqrt(std::max(0.0, all[s].squares[a]) / all[s].readings);
  }
  return scores;
}

SessionZeros SessionTraining::zeros() const {
  const std::size_t taxels = calibration_.no_model.size();
  SessionZeros zeros;
  for (const dataset::Recording& recording : problem_.recordings)
    zeros.emplace_back(recording.conditions.size(), std::vector<regression::FixedPressure>(taxels, 0));
  forEachModelledTaxel([&](std::size_t taxel, const SessionTables& tables) {
    const std::vector<regression::FixedPressure> own = tables.zeros();
    for (std::size_t s = 0; s < own.size(); ++s)
      zeros[sessions_.all[s].recording][sessions_.all[s].condition][taxel] = own[s];
  });
  return zeros;
}

}  // namespace

SessionZeros chooseSessionZero(const HistoryProblem& problem, const Sessions& sessions,
                               const CalibrationOptions& options, Calibration& calibration) {
  if (options.zero == ZeroChoice::kNone) return {};
  if (!sessions.assessable()) {
    refuse(sessions, options.zero, calibration);
    return {};
  }
  const SessionTraining training(problem, sessions, options.threads, calibration);
  SessionScore& score = calibration.scores.session;
  score.sessions = training.score();
  if (score.sessions.empty()) {
    refuse(sessions, options.zero, calibration);
    return {};
  }
  const SessionAnswer answer = choose(options.zero, score);
  if (answer == SessionAnswer::kPlain) return {};
  SessionZero& zero = calibration.session_zero;
  zero.tare = answer == SessionAnswer::kTared ? SessionTare::kTablesAlone : SessionTare::kTrained;
  zero.rmse_without = rmseOf(score.sessions, SessionAnswer::kPlain);
  zero.rmse = rmseOf(score.sessions, answer);
  return answer == SessionAnswer::kZeroed ? training.zeros() : SessionZeros{};
}

}  // namespace fsr::calibration
