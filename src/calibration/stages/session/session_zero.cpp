#include "calibration/stages/session/session_zero.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "calibration/stages/deviation/held_out_scoring.h"
#include "dataset/count_readers.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "matrix/for_each_taxel.h"
#include "settings/number_text.h"
#include "statistics/paired_tests.h"
#include "statistics/samples.h"

namespace fsr::calibration {

namespace {

using regression::FixedPressure;
using regression::Int128;

// Of Newton's method, where the tables are no linear function of the pressures (forest, monotone).
constexpr int kRounds = 4;
constexpr double kStep = 10e3;  // by which a session is moved to see the response of the tables [Pa]
// A rest whose codes other sessions read with less weight than this is not known.
constexpr double kLeastShare = 0.01;
constexpr double kLargestZero = 1e6;  // [Pa]

// The solution z of mean 0 of matrix * z + b = at_rest, with a number b that is the same for all sessions:
// what tables answer too much at rest in any case. All components lie within kLargestZero.
Eigen::VectorXd centredSolution(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& at_rest) {
  const Eigen::Index n = matrix.rows();
  Eigen::MatrixXd a(n, n + 1);
  a << matrix, Eigen::VectorXd::Ones(n);
  Eigen::MatrixXd normal = a.transpose() * a;
  normal.topLeftCorner(n, n) += kLeastShare * kLeastShare * Eigen::MatrixXd::Identity(n, n);
  const Eigen::VectorXd z = normal.ldlt().solve(a.transpose() * at_rest).head(n);
  if (!z.allFinite()) return Eigen::VectorXd::Zero(n);
  return (z.array() - z.mean()).max(-kLargestZero).min(kLargestZero).matrix();
}

// The statistics of the same readings, each larger by `zero`.
regression::CodeStatistics shifted(const regression::CodeStatistics& cell, FixedPressure zero) {
  regression::CodeStatistics result;
  cell.forEach([&](regression::CodeSums sums) {
    sums.sum_of_squares += 2 * Int128{zero} * sums.sum + Int128{sums.count} * zero * zero;
    sums.sum += sums.count * zero;
    result.append(sums);
  });
  return result;
}

void addShifted(const regression::CodeStatistics& cell, FixedPressure zero, regression::CodeHistogram& sums) {
  if (zero == 0)
    sums.add(cell);
  else
    sums.add(shifted(cell, zero));
}

// Adds the squared errors of the readings of one code, to which a table answers `answer`.
double squaresOf(const regression::CodeSums& sums, double answer) {
  const double unit = regression::kFixedPressureUnit;
  return static_cast<double>(sums.sum_of_squares) * unit * unit -
         2 * answer * static_cast<double>(sums.sum) * unit + sums.count * answer * answer;
}

}  // namespace

SessionTables::SessionTables(const HistoryProblem& problem, const Sessions& sessions,
                             const TrainingScans& scans, std::uint16_t full_scale, std::size_t taxel)
    : problem_(problem),
      sessions_(sessions),
      taxel_(taxel),
      readings_(sectionedReadings(scans, sessions.most, full_scale, taxel, problem.regressor)) {
  for (const Session& session : sessions.all)
    rests_.push_back(readingsAtRest(problem.recordings[session.recording], session.rest.scans, taxel));
}

bool SessionTables::leftOut(const Session& session, std::optional<std::uint32_t> number) const {
  return number == session.number && sessions_.assessable(session);
}

regression::ClassReadings SessionTables::readingsWithout(std::optional<std::uint32_t> left_out,
                                                         const Zeros& zeros) const {
  regression::ClassReadings readings;
  readings.full_scale = readings_.full_scale;
  const std::size_t classes = readings_.sums.size();
  readings.sums.assign(classes, regression::CodeHistogram(readings_.full_scale));
  if (!readings_.samples.empty()) readings.samples.resize(classes);
  for (regression::CodeSamples& samples : readings.samples) samples.full_scale = readings_.full_scale;
  for (std::size_t s = 0; s < sessions_.all.size(); ++s) {
    const Session& session = sessions_.all[s];
    if (leftOut(session, left_out)) continue;
    const std::size_t k = session.curvature_class;
    addShifted(readings_.sums[k][session.number], zeros[s], readings.sums[k]);
    if (readings.samples.empty()) continue;
    regression::CodeSamples samples = readings_.samples[k][session.number];
    for (FixedPressure& pressure : samples.pressure) pressure += zeros[s];
    readings.samples[k].append(samples);
  }
  return readings;
}

void SessionTables::move(std::size_t session, FixedPressure zero, FixedPressure step,
                         regression::ClassReadings& readings) const {
  const Session& moved = sessions_.all[session];
  const regression::CodeStatistics& own = readings_.sums[moved.curvature_class][moved.number];
  regression::CodeHistogram& sums = readings.sums[moved.curvature_class];
  sums.subtract(shifted(own, zero));
  sums.add(shifted(own, zero + step));
}

SessionTables::Tables SessionTables::fit(const regression::ClassReadings& readings) const {
  const std::vector<regression::Fit> fits =
      compensation::fitScheme(problem_.plan, taxel_, readings, problem_.regressor);
  Tables tables;
  for (std::size_t k = 0; k < readings.sums.size(); ++k)
    tables.push_back(fits[problem_.plan.model_of_class[k]].pressure);
  return tables;
}

SessionTables::Tables SessionTables::train(std::optional<std::uint32_t> left_out, const Zeros& zeros) const {
  return fit(readingsWithout(left_out, zeros));
}

std::optional<double> SessionTables::zeroOf(std::size_t session, const Tables& tables) const {
  return zeroAtRest(rests_[session], tables[sessions_.all[session].curvature_class]);
}

// What the tables answer too much at the rests of the sessions that trained the model, mean over them.
double SessionTables::zeroInTraining(std::optional<std::uint32_t> left_out, std::size_t model,
                                     const Tables& tables) const {
  const auto of_model = trainedSessions(left_out);
  double sum = 0, count = 0;
  for (const std::size_t s : of_model[model]) {
    const std::optional<double> zero = zeroOf(s, tables);
    sum += zero.value_or(0);
    count += zero ? 1 : 0;
  }
  return count > 0 ? sum / count : 0.0;
}

// The sessions that a zero can be found for, by the model that they train.
std::vector<std::vector<std::size_t>> SessionTables::trainedSessions(
    std::optional<std::uint32_t> left_out) const {
  const compensation::SchemePlan& plan = problem_.plan;
  std::vector<std::vector<std::size_t>> of_model(plan.models.size());
  for (std::size_t s = 0; s < sessions_.all.size(); ++s) {
    const Session& session = sessions_.all[s];
    const std::size_t m = plan.model_of_class[session.curvature_class];
    const bool trains = plan.trainsOn(session.curvature_class);
    if (trains && !session.rest.empty() && !leftOut(session, left_out)) of_model[m].push_back(s);
  }
  return of_model;
}

// Tables of the readings in which some sessions are larger by kStep. Sums change by those of the sessions
// alone, so that the time does not depend on the number of the others. `readings`: without the step, before
// and after.
SessionTables::Tables SessionTables::responseTo(const std::vector<std::size_t>& moved,
                                                std::optional<std::uint32_t> left_out, const Zeros& zeros,
                                                regression::ClassReadings& readings) const {
  const FixedPressure step = regression::toFixed(kStep);
  if (!readings.samples.empty()) {  // single readings have an order
    Zeros larger = zeros;
    for (const std::size_t s : moved) larger[s] += step;
    return train(left_out, larger);
  }
  for (const std::size_t s : moved) move(s, zeros[s], step, readings);
  Tables response = fit(readings);
  for (const std::size_t s : moved) move(s, zeros[s] + step, -step, readings);
  return response;
}

// Tables T and zeros z determine each other: T = S (p + z) with the smoother S of the regressor, and z + b =
// R T - p_rest, where R takes the mean at rest. So (I - R S) z + b = R S p - p_rest. Column j of R S is the
// response of the answers at rest to readings of session j that are larger by 1. z + constant is a solution,
// too; that of mean 0 is taken. Where no other session reads the codes of a rest, nothing is known, and z is
// small. Solving is necessary, since finding T and z in turn hardly moves: at the codes of its own rest a
// table mostly knows the readings of that rest.
void SessionTables::improve(std::optional<std::uint32_t> left_out, const Tables& tables, Zeros& zeros) const {
  const auto of_model = trainedSessions(left_out);
  const auto answers = [&](const std::vector<std::size_t>& own, const Tables& by) {
    Eigen::VectorXd at_rest(own.size());
    for (std::size_t i = 0; i < own.size(); ++i) at_rest[Eigen::Index(i)] = zeroOf(own[i], by).value_or(0);
    return at_rest;
  };
  std::size_t most = 0;
  std::vector<Eigen::MatrixXd> matrix;
  for (const auto& own : of_model) {
    most = std::max(most, own.size());
    matrix.push_back(Eigen::MatrixXd::Identity(Eigen::Index(own.size()), Eigen::Index(own.size())));
  }
  std::vector<Eigen::VectorXd> at_rest;  // before a session is moved
  for (const auto& own : of_model) at_rest.push_back(answers(own, tables));
  regression::ClassReadings readings = readingsWithout(left_out, zeros);
  for (std::size_t j = 0; j < most; ++j) {  // one session of each model at a time
    std::vector<std::size_t> moved;
    for (const auto& own : of_model) {
      if (j < own.size()) moved.push_back(own[j]);
    }
    const Tables response = responseTo(moved, left_out, zeros, readings);
    for (std::size_t m = 0; m < of_model.size(); ++m) {
      if (j >= of_model[m].size()) continue;
      matrix[m].col(Eigen::Index(j)) -= (answers(of_model[m], response) - at_rest[m]) / kStep;
    }
  }
  for (std::size_t m = 0; m < of_model.size(); ++m) {
    const auto& own = of_model[m];
    if (own.size() < 2) continue;
    Eigen::VectorXd beyond = at_rest[m];
    for (std::size_t i = 0; i < own.size(); ++i)
      beyond[Eigen::Index(i)] -= regression::fromFixed(zeros[own[i]]);
    const Eigen::VectorXd step = centredSolution(matrix[m], beyond);
    for (std::size_t i = 0; i < own.size(); ++i) zeros[own[i]] += regression::toFixed(step[Eigen::Index(i)]);
  }
}

SessionTables::Zeros SessionTables::solve(std::optional<std::uint32_t> left_out, Tables& tables) const {
  Zeros zeros(sessions_.all.size(), 0);
  const int rounds = readings_.samples.empty() ? 1 : kRounds;
  for (int round = 0; round < rounds; ++round) {
    improve(left_out, tables, zeros);
    tables = train(left_out, zeros);
  }
  return zeros;
}

std::vector<FixedPressure> SessionTables::zeros() const {
  Tables tables = train({}, Zeros(sessions_.all.size(), 0));
  return solve({}, tables);
}

// Lowest and highest code of the other sessions of the class.
std::array<std::uint16_t, 2> SessionTables::codesWithout(const Session& session) const {
  std::array<std::uint16_t, 2> codes = {0xffff, 0};
  const auto& sections = readings_.sums[session.curvature_class];
  for (std::size_t number = 0; number < sections.size(); ++number) {
    if (number == session.number || sections[number].empty()) continue;
    codes[0] = std::min(codes[0], sections[number].code().front());
    codes[1] = std::max(codes[1], sections[number].code().back());
  }
  return codes;
}

// Without the rest. A code of 0 or at full scale is no value, and a table says nothing beyond the codes that
// it was trained on.
void SessionTables::addErrors(std::size_t number, const Tables& plain, const Tables& zeroed,
                              SessionErrors& errors) const {
  const Session& session = sessions_.all[number];
  const std::size_t k = session.curvature_class;
  if (plain[k].empty() || zeroed[k].empty()) return;
  const std::array<const std::vector<double>*, kSessionAnswers> tables = {&plain[k], &plain[k], &zeroed[k]};
  const std::size_t model = problem_.plan.model_of_class[k];
  const auto tareOf = [&](const Tables& by) {
    const std::optional<double> zero = zeroOf(number, by);
    return zero ? *zero - zeroInTraining(session.number, model, by) : 0.0;
  };
  const std::array<double, kSessionAnswers> zero = {0, tareOf(plain), tareOf(zeroed)};
  const auto [lowest, highest] = codesWithout(session);
  const auto counts = [&, low = lowest, high = highest](std::uint16_t code) {
    return code > 0 && code < readings_.full_scale && code >= low && code <= high;
  };
  const auto add = [&](const regression::CodeSums& sums, double sign) {
    if (!counts(sums.code)) return;
    errors.readings += sign * sums.count;
    for (std::size_t a = 0; a < kSessionAnswers; ++a)
      errors.squares[a] += sign * squaresOf(sums, (*tables[a])[sums.code] - zero[a]);
  };
  readings_.sums[k][session.number].forEach([&](const regression::CodeSums& sums) { add(sums, 1); });
  const dataset::Recording& recording = problem_.recordings[session.recording];
  dataset::TaxelCounts own(recording, taxel_);
  for (const std::size_t scan : session.rest.scans) {
    const FixedPressure pressure = regression::toFixed(recording.pressure[scan]);
    add({own[scan], 1, pressure, Int128{pressure} * pressure}, -1);
  }
}

std::vector<SessionErrors> SessionTables::leaveEachOut() const {
  std::vector<SessionErrors> errors(sessions_.all.size());
  for (std::uint32_t number = 0; number < sessions_.most; ++number) {
    const auto out = [&](const Session& session) { return leftOut(session, number); };
    if (std::none_of(sessions_.all.begin(), sessions_.all.end(), out)) continue;
    const Tables plain = train(number, Zeros(errors.size(), 0));
    Tables zeroed = plain;
    solve(number, zeroed);
    for (std::size_t s = 0; s < errors.size(); ++s) {
      if (out(sessions_.all[s])) addErrors(s, plain, zeroed, errors[s]);
    }
  }
  return errors;
}

namespace {

// Tables of today are kept if tables with zeros are better by no more than this in root mean square.
constexpr double kAsGood = 1.01;
constexpr double kErrorRate = 0.05;  // of "better" and "worse", one-sided

constexpr char kWhatToRecord[] =
    "record a surface in two sessions or more, each starting with 2 s at rest at the lowest pressure";

// Over all readings of the sessions [Pa].
double rmseOf(const std::vector<SessionScore::Session>& sessions, SessionAnswer answer) {
  double sum = 0, readings = 0;
  for (const SessionScore::Session& session : sessions) {
    const double rmse = session.rmse[std::size_t(answer)];
    sum += double(session.readings) * rmse * rmse;
    readings += double(session.readings);
  }
  return std::sqrt(sum / readings);
}

// An answer against the static tables, on sessions that were left out.
struct Comparison {
  double ratio = 1;                                       // of RMSE over all readings
  double p_better = 1, p_worse = 1;                       // one-sided
  double most = std::numeric_limits<double>::infinity();  // upper 95 % bound of the gain, log of RMSE
};

// Student's paired t test over the sessions of the logarithms of RMSE. One session proves nothing.
Comparison compare(const std::vector<SessionScore::Session>& sessions, SessionAnswer answer) {
  Comparison result;
  result.ratio = rmseOf(sessions, answer) / rmseOf(sessions, SessionAnswer::kPlain);
  std::vector<double> before, after;
  for (const SessionScore::Session& session : sessions) {
    const auto logarithm = [&](SessionAnswer one) { return std::log(session.rmse[std::size_t(one)] + 1.0); };
    before.push_back(logarithm(SessionAnswer::kPlain));
    after.push_back(logarithm(answer));
  }
  if (sessions.size() < 2) return result;
  const std::vector<double> gain = statistics::pairedDifferences(before, after, "tare");
  if (statistics::isConstant(gain) && gain.front() != 0) return result;
  const statistics::PairedT test = statistics::pairedT(before, after);
  result.p_better = test.mean_difference > 0 ? test.test.p / 2 : 1 - test.test.p / 2;
  result.p_worse = 1 - result.p_better;
  result.most = test.high;
  return result;
}

// The better of the two ways to use a tare; the simpler one if it is as good.
SessionAnswer better(const std::vector<SessionScore::Session>& sessions) {
  return rmseOf(sessions, SessionAnswer::kTared) <= kAsGood * rmseOf(sessions, SessionAnswer::kZeroed)
             ? SessionAnswer::kTared
             : SessionAnswer::kZeroed;
}

std::string wayText(SessionAnswer answer) {
  return answer == SessionAnswer::kTared ? ", with the tables as without it"
                                         : ", with tables that are trained with the zero of each session";
}

std::string countText(std::size_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

// "it takes 31 % off (p = 0.004) on 5 sessions that were left out".
std::string effectText(const Comparison& found, std::size_t sessions) {
  const double change = 1 - found.ratio;
  const double p = change > 0 ? found.p_better : found.p_worse;
  return "it " + std::string(change > 0 ? "takes " : "adds ") +
         settings::fixedText(100 * std::abs(change), 1) + " % " + (change > 0 ? "off" : "to") +
         " the error on " + countText(sessions, "session") +
         (sessions == 1 ? " that was left out"
                        : " that were left out (p = " + settings::roundedText(p, 2) + ")");
}

// A tare that changes the rest of a session to that of the training does no harm where sessions do not
// differ, and sheets usually differ from session to session. So one is expected unless the sessions speak
// against it.
SessionAnswer choose(ZeroChoice choice, SessionScore& score) {
  const auto& sessions = score.sessions;
  const auto say = [&](const std::string& text) {
    score.choice = "Tare at the start of a session: " + text + ".";
  };
  SessionAnswer best = better(sessions);
  Comparison found = compare(sessions, best);
  const auto wins = [&] { return found.ratio <= kWins && found.p_better < kErrorRate; };
  if (best == SessionAnswer::kZeroed && !wins() && choice == ZeroChoice::kAuto) {
    best = SessionAnswer::kTared;  // other tables need proof
    found = compare(sessions, best);
  }
  const std::string effect = effectText(found, sessions.size());
  if (choice == ZeroChoice::kSession) {
    say("expected, as asked for; " + effect + wayText(best));
  } else if (wins()) {
    say("expected, since " + effect + wayText(best));
  } else if (found.ratio > kWorse || (found.ratio > 1 && found.p_worse < kErrorRate)) {
    say("not expected, since " + effect);
    return SessionAnswer::kPlain;
  } else if (found.most < -std::log(kWins)) {
    say("not expected, since a gain of 2 % is ruled out: " + effect);
    return SessionAnswer::kPlain;
  } else {
    say("expected, since sheets usually differ from session to session; " + effect + ", which may be chance" +
        wayText(best));
  }
  return best;
}

// No session can be left out. Returns whether a tare is expected all the same.
bool expectUnproven(const Sessions& sessions, const std::vector<dataset::Recording>& recordings,
                    ZeroChoice choice, Calibration& calibration) {
  const auto resting =
      static_cast<std::size_t>(std::count_if(sessions.all.begin(), sessions.all.end(),
                                             [](const Session& session) { return !session.rest.empty(); }));
  std::string& text = calibration.scores.session.choice;
  if (resting == 0) {
    const Session& first = sessions.all.front();
    const std::string reason = "no session can be tared: " + first.name(recordings) + ": " +
                               whyNoRest(recordings[first.recording], first.condition) + "; " + kWhatToRecord;
    if (choice == ZeroChoice::kSession) throw settings::InputError("zero session: " + reason);
    text = "Tare at the start of a session: not expected, since " + reason + ".";
    return false;
  }
  text =
      "Tare at the start of a session: expected, since sheets usually differ from session to session. What "
      "it takes off is not known, because no surface has two sessions that start at rest (" +
      countText(sessions.all.size(), "session") + ", " + std::to_string(resting) +
      " of them with a rest at the start); " + kWhatToRecord + ".";
  return true;
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

void rememberRests(const Sessions& sessions, Calibration& calibration) {
  const std::size_t classes = calibration.tables.classes.size();
  std::vector<float>& at_rest = calibration.session_zero.at_rest;
  at_rest.assign(calibration.tables.tables.size(), 0.0F);
  bool any = false;
  for (const Session& session : sessions.all) {
    if (!session.rest.trained) continue;
    any = true;
    const std::size_t k = classes == 1 ? 0 : session.curvature_class;
    for (std::size_t taxel = 0; taxel < calibration.no_model.size(); ++taxel) {
      if (calibration.no_model[taxel] == 0)
        at_rest[taxel * classes + k] = static_cast<float>(
            zeroInTraining(*session.rest.trained, taxel, calibration.tables.table(taxel, k).pressure));
    }
  }
  if (!any) at_rest.clear();
}

SessionZeros chooseSessionZero(const HistoryProblem& problem, const Sessions& sessions,
                               const CalibrationOptions& options, Calibration& calibration) {
  if (options.zero == ZeroChoice::kNone) return {};
  SessionZero& zero = calibration.session_zero;
  SessionScore& score = calibration.scores.session;
  std::optional<SessionTraining> training;
  if (sessions.assessable()) {
    training.emplace(problem, sessions, options.threads, calibration);
    score.sessions = training->score();
  }
  if (score.sessions.empty()) {
    const bool expected = expectUnproven(sessions, problem.recordings, options.zero, calibration);
    zero.tare = expected ? SessionTare::kTablesAlone : SessionTare::kNone;
    return {};
  }
  const SessionAnswer answer = choose(options.zero, score);
  if (answer == SessionAnswer::kPlain) return {};
  zero.tare = answer == SessionAnswer::kTared ? SessionTare::kTablesAlone : SessionTare::kTrained;
  zero.rmse_without = rmseOf(score.sessions, SessionAnswer::kPlain);
  zero.rmse = rmseOf(score.sessions, answer);
  return answer == SessionAnswer::kZeroed ? training->zeros() : SessionZeros{};
}

}  // namespace fsr::calibration
