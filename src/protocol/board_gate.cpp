#include "protocol/board_gate.h"

#include <utility>

namespace fsr::protocol {

void BoardGate::doubt() {
  doubted_ = known_;
  waiting_ = false;
  until_ = 0;
}

// Where the host's time went backwards, the wait ends too: no scan may be held for ever.
BoardGate::Verdict BoardGate::scan(std::int64_t time) {
  if (until_ != 0) {
    if (time < until_ && time >= until_ - settling_) return Verdict::kHold;
    until_ = 0;
  }
  if (!doubted_) return Verdict::kPass;
  if (!std::exchange(waiting_, true)) since_ = time;
  if (time >= since_ && time - since_ < patience_) return Verdict::kHold;
  doubted_ = known_ = false;
  gave_up_ = true;
  return Verdict::kPass;
}

BoardGate::Board BoardGate::identity(std::string_view serial, std::int64_t time) {
  const bool another = known_ && serial != serial_;
  serial_ = serial;
  known_ = true;
  doubted_ = false;
  if (another) until_ = time + settling_;
  return another ? Board::kAnother : Board::kSame;
}

bool BoardGate::gaveUp() {
  return std::exchange(gave_up_, false);
}

}  // namespace fsr::protocol
