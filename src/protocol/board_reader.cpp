#include "protocol/board_reader.h"

#include <sys/resource.h>
#include <exception>
#include <utility>

namespace fsr::protocol {
namespace {

// Of the exception that is being handled.
std::string reason() {
  try {
    throw;
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
    return "unknown exception";
  }
}

}  // namespace

void HandlerGuard::onScan(const PacketHeader& header, const ScanPacket& scan) {
  run("handling a scan", [&] { handler_.onScan(header, scan); });
}

void HandlerGuard::onTransducer(const PacketHeader& header, std::int32_t counts) {
  run("handling a transducer reading", [&] { handler_.onTransducer(header, counts); });
}

void HandlerGuard::onTemperature(const PacketHeader& header, std::int32_t millidegrees) {
  run("handling a temperature", [&] { handler_.onTemperature(header, millidegrees); });
}

void HandlerGuard::onIdentity(const PacketHeader& header, const IdentityPacket& identity) {
  run("handling an identity", [&] { handler_.onIdentity(header, identity); });
}

void HandlerGuard::onTrigger(const PacketHeader& header, const TriggerPacket& trigger) {
  run("handling a trigger", [&] { handler_.onTrigger(header, trigger); });
}

void HandlerGuard::note(const char* task) {
  ++faults_;
  complaint_ = std::string(task) + " failed in this program, not on the link: " + reason();
}

namespace {

using SteadyClock = std::chrono::steady_clock;

// Longest wait of a read, and so of the destructor.
constexpr std::chrono::milliseconds kReadTimeout(100);
constexpr std::size_t kBufferSize = 16384;  // [bytes]: more than a pseudo-terminal or USB driver holds back

// The kernel keeps 64 KB for a port, which is 0.2 s of 16 x 10 taxels at 1 kHz; what comes while nobody reads
// is lost. So the reading thread takes a higher priority (-20 to 19) where the system permits it: as root, or
// with RLIMIT_NICE.
constexpr int kNiceness = -10;

void raisePriority() {
  ::setpriority(PRIO_PROCESS, 0, kNiceness);  // on Linux: of the calling thread
}

std::unique_ptr<CaptureWriter> captureTo(const std::string& path) {
  return path.empty() ? nullptr : std::make_unique<CaptureWriter>(path);
}

}  // namespace

BoardReader::BoardReader(Open open, LinkHandler& handler, const Options& options)
    : open_(std::move(open)),
      handler_(handler),
      options_(options),
      guard_(handler),
      decoder_(options.make_decoder(guard_, options.decoder)),
      capture_(captureTo(options.capture_file)),
      buffer_(kBufferSize),
      last_byte_(SteadyClock::now()),
      thread_([this] { run(); }) {}

BoardReader::~BoardReader() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void BoardReader::setEnabled(bool enabled) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    toggled_ = toggled_ || enabled_ != enabled;
    enabled_ = enabled;
  }
  changed_.notify_all();
}

LinkReport BoardReader::report() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  LinkReport report = report_;
  report.silence = std::chrono::duration<double>(SteadyClock::now() - last_byte_).count();
  return report;
}

void BoardReader::run() {
  raisePriority();
  while (true) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (stopping_) return;
      toggled_ = false;
    }
    if (wanted()) {
      connect();
    } else {
      change(LinkPhase::kDisabled, "");
      pause(std::nullopt);
    }
  }
}

// One connection, from opening to its end, and the pause behind it. What the handler throws does not come
// here: guard_ catches it.
void BoardReader::connect() {
  try {
    const std::unique_ptr<ByteSource> source = open_();
    guard_.run("preparing for a new connection", [&] { handler_.onOpen(source->baud()); });
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ++report_.connections;
      last_byte_ = SteadyClock::now();
    }
    keeping([&] { capture_->noteBaud(source->baud()); });
    readAll(*source);
    finishStream();
    if (!source->ended()) return;
    change(LinkPhase::kEnded, source->remark());
    pause(std::nullopt);
  } catch (const std::exception& error) {
    finishStream();
    change(LinkPhase::kWaiting, error.what());
    pause(options_.reconnect_delay);
  }
}

void BoardReader::readAll(ByteSource& source) {
  change(LinkPhase::kReading, "");
  while (wanted() && !source.ended()) {
    const Chunk chunk = source.read(buffer_.data(), buffer_.size(), kReadTimeout);
    if (chunk.size > 0) take(buffer_.data(), chunk);
  }
}

void BoardReader::take(const std::uint8_t* bytes, const Chunk& chunk) {
  const bool time_runs = chunk.receive_time > 0;
  change(time_runs ? LinkPhase::kReading : LinkPhase::kNoTime, "");
  if (time_runs) {
    keeping([&] { capture_->write(bytes, chunk.size, chunk.receive_time); });
    decode(bytes, chunk);
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    report_.counts = decoder_->counts();
    if (time_runs && capture_) report_.captured_bytes += chunk.size;
    last_byte_ = SteadyClock::now();
  }
  reportFaults();
}

void BoardReader::decode(const std::uint8_t* bytes, const Chunk& chunk) {
  guard_.run("noting the arrival of bytes", [&] { handler_.onBytes(chunk.receive_time); });
  guard_.run("decoding", [&] { decoder_->feed(bytes, chunk.size); });
}

void BoardReader::finishStream() {
  guard_.run("decoding", [&] { decoder_->finish(); });
  reportFaults();
}

// A full disk ends the capture, not the link.
void BoardReader::keeping(const std::function<void()>& write) {
  if (!capture_) return;
  try {
    write();
  } catch (const LinkError& error) {
    capture_.reset();
    const std::lock_guard<std::mutex> lock(mutex_);
    report_.capture_complaint = error.what();
  }
}

void BoardReader::change(LinkPhase phase, const std::string& reason) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (report_.phase == phase && report_.reason == reason) return;
    report_.phase = phase;
    report_.reason = reason;
  }
  tellChange();
}

void BoardReader::tellChange() {
  guard_.run("reporting the state of the link", [&] { handler_.onChange(report()); });
  reportFaults();
}

// The handler is told of its first fault only: a handler that fails on every scan would fill the log.
void BoardReader::reportFaults() {
  if (reported_faults_ == guard_.faults()) return;
  const bool first = reported_faults_ == 0;
  reported_faults_ = guard_.faults();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    report_.handler_faults = guard_.faults();
    report_.handler_complaint = guard_.complaint();
  }
  if (first) tellChange();
}

bool BoardReader::wanted() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return enabled_ && !stopping_;
}

// Until the link is enabled, disabled or destroyed, at most for `longest` where that is given.
void BoardReader::pause(std::optional<std::chrono::milliseconds> longest) {
  std::unique_lock<std::mutex> lock(mutex_);
  const auto woken = [this] { return stopping_ || toggled_; };
  if (longest) {
    changed_.wait_for(lock, *longest, woken);
  } else {
    changed_.wait(lock, woken);
  }
}

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
