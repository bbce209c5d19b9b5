#include <diagnostic_updater/diagnostic_updater.h>
#include <fsr_pressure_map/Event.h>
#include <ros/console.h>
#include <ros/node_handle.h>
#include <std_srvs/SetBool.h>

#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <sstream>
#include <utility>
#include <vector>

#include "fsr_pressure_map/protocol/decoder.h"
#include "protocol/board_reader.h"
#include "protocol/device_clock.h"
#include "protocol/serial_port.h"
#include "ros/bags/resource_path.h"
#include "ros/driver/driver_health.h"
#include "ros/live/parameters.h"
#include "ros/live/serve.h"
#include "ros/messages/driver_messages.h"

namespace fsr_ros {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TransducerLine readLine(const Parameters& parameters) {
  TransducerLine line;
  line.offset = parameters.number("transducer_offset", line.offset, {-1e8, 1e8, "Pa"});
  line.slope = parameters.number("transducer_slope", line.slope, {-1e6, 1e6, "Pa/count"});
  line.absolute = parameters.flag("transducer_absolute", line.absolute);
  line.deviation = parameters.number("transducer_deviation", line.deviation, {0, 1e7, "Pa"});
  if (line.slope == 0) throw parameters.error("transducer_slope", "must not be 0");
  return line;
}

fsr::matrix::MatrixSize readSize(const Parameters& parameters) {
  const fsr::settings::Range side = {0, fsr::matrix::kMaxMatrixSide, ""};
  return {static_cast<std::uint16_t>(parameters.integer("rows", 0, side)),
          static_cast<std::uint16_t>(parameters.integer("columns", 0, side))};
}

void readLink(const Parameters& parameters, DriverSettings& settings) {
  settings.serial_port = resolveResource(parameters.text("serial_port", settings.serial_port));
  settings.serial_baud =
      static_cast<std::uint32_t>(parameters.integer("serial_baud", settings.serial_baud, {0, 12e6, "baud"}));
  settings.protocol = fsr::protocol::protocolNamed(parameters.text("protocol", settings.protocol)).name;
  settings.read_timeout = parameters.number("read_timeout", settings.read_timeout, {0.01, 3600, "s"});
  const double delay = parameters.number("reconnect_delay", 1.0, {0.01, 3600, "s"});
  settings.reconnect_delay = std::chrono::milliseconds(static_cast<std::int64_t>(delay * 1000));
  settings.capture_file = resolveResource(parameters.text("capture_file", ""));
  settings.replay_file = resolveResource(parameters.text("replay_file", ""));
  if (settings.serial_port.empty()) throw parameters.error("serial_port", "must name the port of the board");
}

// What the bytes of some protocols do not say.
fsr::protocol::DecoderOptions readDecoder(const Parameters& parameters, const DriverSettings& settings) {
  fsr::protocol::DecoderOptions options;
  options.size = settings.expected;
  options.full_scale = static_cast<std::uint16_t>(
      parameters.integer("text_full_scale", options.full_scale, {1, 65535, "counts"}));
  options.tick = parameters.choice("text_time", {"ms", "us"}, "ms") == "ms" ? 1000 : 1;
  options.transducer = parameters.flag("text_transducer", options.transducer);
  const bool tells_size = fsr::protocol::protocolNamed(settings.protocol).tells_size;
  for (const auto& [name, side] : {std::pair("rows", options.size.rows), {"columns", options.size.columns}}) {
    if (tells_size || side > 0) continue;
    throw parameters.error(name, "must be 1 or more with the protocol " + settings.protocol +
                                     ", whose lines do not say the size of the matrix");
  }
  return options;
}

void readIdentity(const Parameters& parameters, DriverSettings& settings) {
  settings.frame_id = parameters.text("frame_id", settings.frame_id);
  settings.sensor_id = parameters.text("sensor_id", "");
  settings.sensor_model = parameters.text("sensor_model", "");
  settings.sealing = parameters.text("sealing", "");
  settings.transducer = parameters.text("transducer", "");
  settings.reference_voltage = parameters.number("reference_voltage", 0, {0, 1000, "V"});
  settings.feedback_resistance = parameters.number("feedback_resistance", 0, {0, 1e12, "ohm"});
  settings.pitch_x = parameters.number("pitch_x", settings.pitch_x, {1e-4, 1, "m"});
  settings.pitch_y = parameters.number("pitch_y", settings.pitch_y, {1e-4, 1, "m"});
}

// Reads and checks the private parameters, and warns of unknown ones.
DriverSettings readDriverSettings(const Parameters& parameters) {
  DriverSettings settings;
  readLink(parameters, settings);
  readIdentity(parameters, settings);
  settings.expected = readSize(parameters);
  settings.decoder = readDecoder(parameters, settings);
  settings.transducer_line = readLine(parameters);
  settings.time_offset = parameters.number("time_offset", 0, {-3600, 3600, "s"});
  settings.ambient_pressure =
      parameters.number("ambient_pressure", settings.ambient_pressure, {0, 1e7, "Pa"});
  settings.expected_frequency = parameters.number("expected_frequency", 0, {0, 1e5, "1/s"});
  settings.frequency_tolerance = parameters.number("frequency_tolerance", 0.1, {0, kInfinity, ""});
  parameters.warnOfUnknown("driver");
  return settings;
}

constexpr std::uint32_t kQueue = 10000;  // queue of each topic [messages]: ten seconds at 1 kHz
constexpr int kLooksPerSecond = 10;
constexpr double kComplaintPeriod = 30.0;  // [s]
// Size of the scans that wait for the identity of their board [bytes]: seconds at any rate of a serial line.
constexpr std::size_t kMostHeld = 64 << 20;

std::int64_t rosTime() {
  return static_cast<std::int64_t>(ros::Time::now().toNSec());
}

// Simulated time may run many times faster than real time, so that a short delay of a process is seconds
// long.
fsr::protocol::DeviceClockOptions clockOptions() {
  fsr::protocol::DeviceClockOptions options;
  if (!ros::Time::isSimTime()) return options;
  options.host_ticks = true;
  options.early_limit = 5;
  options.late_limit = 10;
  options.late_patience = 60;
  return options;
}

// The baud rate from which the stamper computes the duration of a transfer. In simulated time bytes take no
// time.
std::uint32_t baudInRosTime(std::uint32_t baud) {
  return ros::Time::isSimTime() ? 0 : baud;
}

fsr::protocol::BoardReader::Open opener(const DriverSettings& settings) {
  if (settings.replay_file.empty()) {
    return [port = settings.serial_port, baud = settings.serial_baud] {
      return std::make_unique<fsr::protocol::SerialPort>(port, baud, rosTime);
    };
  }
  const fsr::protocol::CaptureReader throws_if_not_a_capture(settings.replay_file);
  return [file = settings.replay_file] {
    return std::make_unique<fsr::protocol::PacedSource>(std::make_unique<fsr::protocol::CaptureReader>(file),
                                                        rosTime);
  };
}

bool operator!=(const Board& a, const Board& b) {
  return a.serial != b.serial || a.firmware != b.firmware || a.size != b.size || a.full_scale != b.full_scale;
}

class Driver : private fsr::protocol::LinkHandler {
 public:
  // Throws fsr::InputError for parameters and files that cannot be used. If the port does not exist, the
  // driver waits for it.
  Driver(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle)
      : handle_(handle),
        private_handle_(private_handle),
        settings_(readDriverSettings(Parameters(private_handle))),
        stamper_(clockOptions()),
        diagnostics_(handle, private_handle, private_handle.getNamespace()) {
    raw_ = handle_.advertise<fsr_pressure_map::MatrixFrame>("raw", kQueue);
    pressure_ = handle_.advertise<sensor_msgs::FluidPressure>("chamber_pressure", kQueue);
    temperature_ = handle_.advertise<sensor_msgs::Temperature>("temperature", kQueue);
    events_ = handle_.advertise<fsr_pressure_map::Event>("events", kQueue);
    info_ = handle_.advertise<fsr_pressure_map::MatrixInfo>("matrix_info", 10, true);
    service_ = private_handle_.advertiseService("set_enabled", &Driver::setEnabled, this);
    diagnostics_.add("link", [this](auto& status) { judgeLink(before_, now_, settings_, status); });
    diagnostics_.add("scans", [this](auto& status) { judgeScans(before_, now_, settings_, status); });
    const fsr::protocol::BoardReader::Options options = {
        settings_.reconnect_delay, settings_.capture_file,
        fsr::protocol::protocolNamed(settings_.protocol).make, settings_.decoder};
    fsr::protocol::LinkHandler& handler = *this;
    reader_ = std::make_unique<fsr::protocol::BoardReader>(opener(settings_), handler, options);
    timer_ = handle_.createWallTimer(ros::WallDuration(1.0 / kLooksPerSecond),
                                     [this](const ros::WallTimerEvent&) { look(); });
  }

 private:
  void onScan(const fsr::protocol::PacketHeader& header, const fsr::protocol::ScanPacket& scan) override {
    const fsr::protocol::PacketTime time = stamper_.scan(header, scan.duration);
    const fsr::protocol::DeviceClock& clock = stamper_.clock();
    if (std::exchange(jumps_, clock.jumps()) != clock.jumps()) doubtBoard();
    const std::uint64_t jumps = clock.jumps() + clock.smallJumps();
    if (std::exchange(all_jumps_, jumps) != jumps) reportJump(clock.lastJump());
    const bool expected = isExpected(scan.size);
    const auto message = scanMessage(header, scan, time, settings_);
    if (expected && !message->header.stamp.isZero()) publishScan(message);
    const std::lock_guard<std::mutex> lock(mutex_);
    health_.board.size = scan.size;
    health_.board.full_scale = scan.full_scale;
    ++(expected ? health_.scans : health_.refused_scans);
    health_.scan_time = time.device_time;
    health_.scan_arrival = arrival_;
    health_.clock_drift = clock.drift();
    health_.clock_jumps = jumps;
    health_.doubtful_stamps = clock.doubtfulPackets();
    health_.impossible_durations = stamper_.impossibleDurations();
  }

  void onTransducer(const fsr::protocol::PacketHeader& header, std::int32_t counts) override {
    const auto message = pressureMessage(counts, stamper_.transducer(header), settings_);
    if (!message->header.stamp.isZero()) pressure_.publish(message);
  }

  void onTemperature(const fsr::protocol::PacketHeader& header, std::int32_t millidegrees) override {
    const auto message = temperatureMessage(millidegrees, stamper_.temperature(header), settings_);
    if (!message->header.stamp.isZero()) temperature_.publish(message);
  }

  void onIdentity(const fsr::protocol::PacketHeader& /*header*/,
                  const fsr::protocol::IdentityPacket& identity) override {
    note(toBoard(identity));
    if (gate_.identity(identity.serial, arrival_) == fsr::protocol::BoardGate::Board::kSame) releaseHeld();
  }

  void onTrigger(const fsr::protocol::PacketHeader& header,
                 const fsr::protocol::TriggerPacket& trigger) override {
    const fsr_pressure_map::Event event = triggerMessage(trigger, stamper_.trigger(header), settings_);
    if (!event.header.stamp.isZero()) events_.publish(event);
  }

  void onOpen(std::uint32_t baud) override {
    stamper_.startLine(baudInRosTime(baud));
    doubtBoard();
  }

  void onBytes(std::int64_t receive_time) override {
    arrival_ = receive_time;
    stamper_.setArrival(receive_time);
  }

  void onChange(const fsr::protocol::LinkReport& report) override {
    if (report.handler_faults > 0 && !std::exchange(fault_logged_, true)) {
      ROS_ERROR_STREAM(private_handle_.getNamespace() << ": " << report.handler_complaint);
    }
    const std::string sentence = linkSentence(report, settings_);
    if (report.phase == fsr::protocol::LinkPhase::kWaiting ||
        report.phase == fsr::protocol::LinkPhase::kNoTime) {
      ROS_WARN_STREAM(private_handle_.getNamespace() << ": " << sentence);
    } else {
      ROS_INFO_STREAM(private_handle_.getNamespace() << ": " << sentence);
    }
  }

  bool isExpected(fsr::matrix::MatrixSize size) const {
    const fsr::matrix::MatrixSize expected = settings_.expected;
    return (expected.rows == 0 || expected.rows == size.rows) &&
           (expected.columns == 0 || expected.columns == size.columns);
  }

  // Publishes a scan at once, or holds it until the board has sent its identity. Where too many scans wait
  // already, it is dropped and counted.
  void publishScan(const fsr_pressure_map::MatrixFramePtr& message) {
    const bool hold = gate_.scan(arrival_) == fsr::protocol::BoardGate::Verdict::kHold;
    if (gate_.gaveUp()) note({});
    if (!hold) {
      releaseHeld();
      raw_.publish(message);
      const std::lock_guard<std::mutex> lock(mutex_);
      ++health_.published;
    } else if (held_.size() * (sizeof *message + 2 * message->counts.size()) < kMostHeld) {
      held_.push_back(message);
    } else {
      const std::lock_guard<std::mutex> lock(mutex_);
      ++health_.unclaimed_scans;
    }
  }

  void releaseHeld() {
    for (const auto& message : held_) raw_.publish(message);
    const std::lock_guard<std::mutex> lock(mutex_);
    health_.published += held_.size();
    held_.clear();
  }

  // Into the recording, too: nothing else there shows which stamps are wrong.
  void reportJump(const fsr::protocol::ClockJump& jump) {
    std::ostringstream sentence;
    sentence << "the clock of the board or of the computer jumped: packets came " << std::abs(jump.seconds)
             << " s " << (jump.seconds > 0 ? "later" : "earlier") << " than before; the stamps of "
             << jump.packets << " packets before this are wrong by as much";
    ROS_WARN_STREAM(private_handle_.getNamespace() << ": " << sentence.str());
    fsr_pressure_map::Event event;
    event.header.stamp = ros::Time::now();
    event.kind = "note";
    event.label = sentence.str();
    events_.publish(event);
  }

  void doubtBoard() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      health_.unclaimed_scans += held_.size();
    }
    held_.clear();
    gate_.doubt();
  }

  void note(const Board& board) {
    bool news = false;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      news = health_.board != board;
      health_.board = board;
    }
    if (!news) return;
    ROS_INFO_STREAM(private_handle_.getNamespace()
                    << ": board " << board.serial << ", firmware " << board.firmware << ", "
                    << board.size.rows << " x " << board.size.columns << " taxels");
    publishInfo();
  }

  void publishInfo() {
    fsr_pressure_map::MatrixInfo info = matrixInfo(board(), settings_);
    if (info.rows == 0) return;
    info.header.stamp = ros::Time::now();
    info_.publish(info);
  }

  bool setEnabled(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response) {
    reader_->setEnabled(request.data);
    response.success = true;
    response.message = (request.data ? "opening " : "closing ") + sourceName(settings_);
    return true;
  }

  // Publishes diagnostics each second, and at once when the link has changed.
  void look() {
    const DriverHealth now = health();
    const bool second_passed = ++looks_ % kLooksPerSecond == 0;
    const bool changed = now.link.phase != now_.link.phase || now.link.reason != now_.link.reason;
    if (second_passed) {
      publishInfo();
      before_ = std::exchange(last_second_, now);
    }
    if (!second_passed && !changed) return;
    now_ = now;
    diagnostics_.setHardwareID(now_.board.serial.empty() ? sourceName(settings_) : now_.board.serial);
    diagnostics_.force_update();
    if (second_passed) logComplaint();
  }

  // The same sentence as in the diagnostics, for users without a viewer of them.
  void logComplaint() {
    const std::string complaint = complaintOf(before_, now_, settings_);
    const double time = ros::SteadyTime::now().toSec();
    if (complaint.empty()) {
      if (std::exchange(complained_, 0) > 0)
        ROS_INFO_STREAM(private_handle_.getNamespace() << ": scans come");
    } else if (complained_ == 0 || time - complained_ > kComplaintPeriod) {
      complained_ = time;
      ROS_ERROR_STREAM(private_handle_.getNamespace() << ": " << complaint);
    }
  }

  Board board() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return health_.board;
  }

  DriverHealth health() const {
    const fsr::protocol::LinkReport link = reader_->report();
    const std::lock_guard<std::mutex> lock(mutex_);
    DriverHealth health = health_;
    health.link = link;
    return health;
  }

  ros::NodeHandle handle_;
  ros::NodeHandle private_handle_;
  DriverSettings settings_;
  ros::Publisher raw_;
  ros::Publisher pressure_;
  ros::Publisher temperature_;
  ros::Publisher events_;
  ros::Publisher info_;
  // Used by the thread of the link only:
  fsr::protocol::PacketStamper stamper_;
  fsr::protocol::BoardGate gate_;
  std::vector<fsr_pressure_map::MatrixFramePtr> held_;  // scans of a board that has not sent its identity
  std::uint64_t all_jumps_ = 0;                         // small ones included
  std::uint64_t jumps_ = 0;                             // jumps of the board's clock so far
  bool fault_logged_ = false;                           // an exception of this handler was logged
  std::int64_t arrival_ = 0;                            // time of arrival of the current bytes [ns]

  mutable std::mutex mutex_;  // guards health_, which both threads use
  DriverHealth health_;

  diagnostic_updater::Updater diagnostics_;
  // Diagnostics compare now_ with before_, which is one to two seconds older.
  DriverHealth before_;
  DriverHealth last_second_;
  DriverHealth now_;
  int looks_ = 0;
  double complained_ = 0;  // when the log last said why no scans come (monotonic clock [s]); 0 = scans come
  ros::ServiceServer service_;
  ros::WallTimer timer_;
  std::unique_ptr<fsr::protocol::BoardReader> reader_;  // last: its thread uses everything above
};

}  // namespace

Server makeDriver(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle) {
  return std::make_shared<Driver>(handle, private_handle);
}

}  // namespace fsr_ros
