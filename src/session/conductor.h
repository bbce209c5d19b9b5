#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "session/plan.h"
#include "session/plan_steps.h"
#include "session/sheet_watch.h"
#include "session/step_watch.h"

namespace fsr::session {

/// What is to be done now, and what a person is told. `kind` is kDone where all is done.
struct Instruction : SessionStep {
  std::string plan;
  std::size_t step = 0;  ///< from 1; of the last step where all is done
  std::size_t steps = 0;
  std::string text;      ///< a sentence
  std::string remark;    ///< why the last attempt was rejected, and what hinders; empty = nothing
  bool confirm = false;  ///< a person must confirm
};

/// What one scan says about the matrix.
struct ScanSummary {
  double time = 0;         ///< [s]
  unsigned lost = 0;       ///< scans lost between the scan before and this one
  unsigned taxels = 0;     ///< taxels of the matrix
  unsigned saturated = 0;  ///< taxels at full scale
  unsigned dead = 0;       ///< dead or stuck taxels
  /// [rows x columns], row-major, valid during the call; null = not known, and then only pressures and the
  /// numbers above are judged.
  const std::uint16_t* counts = nullptr;
  std::size_t columns = 0;  ///< of the matrix
};

enum class StepState : char { kOpen = '.', kAccepted = 'a', kSkipped = 's' };

/// What happened at a step: for the terminal and for the events in the bag.
struct Outcome {
  std::size_t step = 0;                ///< index
  StepState state = StepState::kOpen;  ///< kOpen = rejected
  Verdict verdict;
  bool mount_again = false;  ///< the whole mount begins again: what was recorded of it does not count
};

/// The reply to a person.
struct Answer {
  bool done = false;
  std::string sentence;
};

/// Why an attempt at a step was rejected, or accepted by hand.
struct StepRemark {
  std::size_t step = 0;           ///< index
  Reason reason = Reason::kNone;  ///< kNone = accepted by hand
  std::string sentence;
};

/// What is kept between two runs.
struct ConductorState {
  std::string plan;                 ///< its name
  std::string digest;               ///< of the plan, see digestOf()
  std::vector<StepState> steps;     ///< of each step
  unsigned rejected = 0;            ///< rejected attempts so far
  double time = 0;                  ///< when it was so [s]
  std::vector<StepRemark> remarks;  ///< in their order, the latest kMostRemarks

  static constexpr std::size_t kMostRemarks = 1000;
};

/// SHA-256 of the steps of a plan and the forms of its surfaces: a state belongs to one plan, however its
/// file is worded.
std::string digestOf(const SessionPlan& plan);

/// Leads a person, or a rig with a regulator, through a plan. It says what to do next, recognises each step
/// in the pressure of the chamber and in the scans, and accepts it or rejects it with a reason. A step that
/// was rejected is asked for again. Nothing here drives the chamber.
///
/// All times are those of one clock [s]. Readings may come at any rate; each is compared with its two
/// neighbours, so that a single spike spoils nothing, and is judged one reading later. Memory does not grow.
class Conductor {
 public:
  /// The plan must be valid. A plan without steps is done. `silence`: time without a reading, or without a
  /// scan, until it is said [s].
  explicit Conductor(const SessionPlan& plan, double silence = 2);
  /// Goes on where a session stopped. Inside a mount, a person must first confirm that the sheet has stayed
  /// on the surface. Throws InputError for the state of another plan.
  Conductor(const SessionPlan& plan, const ConductorState& state, double silence = 2);
  ~Conductor();
  Conductor(Conductor&&) noexcept;

  /// A reading of the chamber, gauge [Pa]; NaN = the transducer gives none.
  void pressure(double time, double gauge);
  void scan(const ScanSummary& scan);
  /// The surface that is declared to be under the sheet.
  void surface(const std::string& name);
  /// Why the bag is not written; empty = it is. Steps that belong into a bag are rejected meanwhile.
  void recordingTrouble(const std::string& sentence);
  /// The time when nothing comes. Call it at least once a second.
  void tick(double time);
  /// Space on the disk, and what a recording takes of it.
  void disk(double free_bytes, double bytes_per_second);
  /// Until when the session must be over, on the clock of the readings [s].
  void deadline(double time) { deadline_ = time; }

  /// The sheet lies on the surface of the step.
  Answer confirm();
  /// Takes the attempt that was rejected last as good.
  Answer accept();
  /// Rejects the attempt that runs, or else takes back the step accepted last on this mount. While a person
  /// is asked whether the sheet has stayed on its surface: begins the mount again. Refused when all is done.
  Answer reject(const std::string& reason);
  /// Goes on without the present step. At a mount: without all steps of the mount.
  Answer skip();

  Instruction instruction() const;
  bool done() const { return step_ >= steps_.size(); }
  /// The present step; null where all is done.
  const SessionStep* step() const { return done() ? nullptr : &steps_[step_]; }
  /// Whether an attempt was rejected and the pressure is not down yet, and whether a person must confirm.
  bool recovering() const { return recovering_; }
  bool waitsForMount() const;
  /// Deviation of a single count without load [counts], as measured last; 0 = not known yet.
  double noiseAtRest() const { return noise_; }
  /// Whether the present step belongs into a bag, and the sheet is known to lie on its surface.
  bool recording() const { return !done() && !resumed_ && steps_[step_].recorded; }
  const std::vector<SessionStep>& steps() const { return steps_; }
  const std::vector<StepState>& states() const { return state_.steps; }
  ConductorState state() const;
  /// Changes with each step that is accepted, rejected, skipped or taken back.
  std::uint64_t revision() const { return revision_; }
  /// Planned time of the steps that are open, or of the recorded ones among them [s].
  double timeLeft(bool recorded = false) const;
  /// What hinders just now, most urgent first.
  const std::map<Reason, std::string>& complaints() const { return complaints_; }

  /// What has happened since the last call, at most kMostOutcomes; older ones are dropped.
  std::vector<Outcome> takeOutcomes();
  static constexpr std::size_t kMostOutcomes = 100;

 private:
  void judge(const Reading& reading);
  bool isDoubted(const Reading& reading);
  void use(const Reading& reading);
  void settleJump();
  void complainOfLoadBeforeMount(double pressure);
  void take(const Reading& reading);
  void handle(const Verdict& verdict, const Reading& reading);
  void acceptStep(const Verdict& verdict);
  void rejectStep(const Verdict& verdict);
  void note(std::size_t step, StepState state, const Verdict& verdict, bool mount_again = false);
  void spoil(Reason reason, const std::string& sentence);
  void hinder(Reason reason, const std::string& sentence);
  void goOn(bool after_loop = false);
  void restartWatch(bool after_loop = false);
  void skipMount();
  Verdict withScans(Verdict verdict);
  void complain(Reason reason, const std::string& sentence, bool holds = true);
  void setHint();
  bool isValid(double gauge);
  void checkSilence();
  void checkBreak();
  void checkFit();
  bool passTime(double time, const std::optional<double>& last);
  void jumpTo(double time);
  bool attemptRuns() const { return watch_ && watch_->running() && !recovering_; }
  bool isHindered() const;
  bool isFirstLoad() const;
  void readMatrix(const ScanSummary& scan);
  void checkSheet(const ScanSummary& scan);
  Verdict withSurface(Verdict verdict);
  void insistOn(const SurfaceDoubt& doubt, Verdict* verdict);
  void beginMountAgain(const Verdict& verdict);
  std::string remark() const;
  std::string text() const;

  SessionPlan plan_;
  double silence_;
  std::vector<SessionStep> steps_;
  ConductorState state_;  // its time is now_
  std::size_t step_ = 0;
  bool resumed_ = false;     // inside a mount, and nobody has confirmed that the sheet stayed
  bool recovering_ = false;  // an attempt was rejected, and the pressure is not down yet
  unsigned attempts_ = 0;    // rejected at this step
  Verdict last_rejected_;    // at this step
  std::unique_ptr<StepWatch> watch_;
  RestClock rest_;
  RestClock rest_before_;  // before the last reading that was judged
  Reading last_judged_;
  bool judged_ = false;          // last_judged_ is one
  std::vector<Reading> recent_;  // the last two, for the median
  JumpWatch jumps_;
  std::vector<Reading> held_;                        // since a jump, until the sheet has told what it was
  bool unfollowed_ = false;                          // the pressure jumped, and the sheet did not follow
  double now_ = 0;                                   // latest time of all [s]
  bool started_ = false;                             // a time is known
  std::optional<double> last_pressure_, last_scan_;  // times [s]
  unsigned scans_ = 0, lost_ = 0;                    // of the present attempt
  unsigned dead_ = 0, dead_known_ = 0;               // taxels now, and those that were said
  bool loaded_ = false;                              // a load was accepted, so that dead taxels are known
  std::string declared_;                             // surface
  LoadingSignature loading_;                         // of the first load of the mount
  std::size_t loading_step_ = 0;                     // which step that is; 0 = none
  std::size_t loading_columns_ = 0;                  // of the matrix
  SurfaceWatch surfaces_;
  std::optional<unsigned> doubted_;  // mount whose surface a person was asked to look at
  RestCounts rest_counts_;           // on this mount
  double largest_excess_ = 0;        // of the sheet under load, above its rest [counts]
  double noise_ = 0;                 // of a count at rest [counts]; stays over mounts
  std::optional<double> answered_;   // largest pressure that the sheet needed to answer [Pa]
  std::optional<double> answers_;    // likewise in the present attempt
  unsigned silent_ = 0;              // scans in a row in which nothing answers
  double step_begin_ = 0;            // of the present step [s]
  std::uint64_t revision_ = 0;
  double free_bytes_ = -1, bytes_per_second_ = 0;  // negative = not known
  std::optional<double> deadline_;
  std::map<Reason, std::string> complaints_;
  std::vector<Outcome> outcomes_;
};

}  // namespace fsr::session
