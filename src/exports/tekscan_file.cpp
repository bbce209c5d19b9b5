#include "exports/scan_formats.h"

#include <cmath>

#include "exports/scan_record.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "settings/number_text.h"

namespace fsr::exports {

namespace {

constexpr char kEnd[] = "\r\n";
constexpr char kNoSensel[] = "B";
constexpr std::size_t kPiece = 1u << 16;  // of the times that are written at once [bytes]
constexpr std::size_t kRoom = 12;         // space for a number that is known only at the end [characters]

std::string padded(std::string text) {
  text.resize(std::max(text.size(), kRoom), ' ');
  return text;
}

// Month/day/year and time of day with milliseconds, UTC.
std::string date(std::int64_t stamp_ns) {
  return dateText(stamp_ns, "%m/%d/%Y %H:%M:%S") + secondsText(stamp_ns % 1000000000).substr(1, 4);
}

// Pressure [kPa]. Nine digits restore each float32 of the map.
std::string pressureValue(float pressure) {
  return std::isnan(pressure) ? kNoSensel : settings::roundedText(double(pressure) * 1e-3, 9);
}

std::string value(const ScanRecord& scan, bool maps, std::size_t taxel) {
  if (maps) return scan.map ? pressureValue(scan.map->pressure[taxel]) : kNoSensel;
  return scan.counts.empty() ? kNoSensel : std::to_string(scan.counts[taxel]);
}

// Frames in the ASCII format of Tekscan's I-Scan and F-Scan (*.asf). A header of "KEY value" lines ends with
// ASCII_DATA @@. Each frame has a line "Frame N" and one line for each row, with values separated by commas;
// `B` means no sensel or no reading. The line "@@" ends the frames. Lines end with CR LF. Maps are in kPa
// (UNITS kPa), recordings without maps in counts (UNITS RAW).
//
// The format assumes evenly spaced frames. The true time of each frame is in lines "FRAME_TIME N seconds"
// after the final "@@", which readers of the format ignore.
class TekscanFile : public ScanSink {
 public:
  explicit TekscanFile(const std::string& path) : path_(path), file_(path) {}

  void begin(const ExportSubject& subject) override { subject_ = subject; }

  void add(const ScanRecord& scan) override {
    if (times_.empty()) {
      layout_ = scan.layout;
      file_.write(header(scan));
    }
    requireOneSize(subject_, layout_.size, scan.layout.size, "a Tekscan file has");
    times_.push_back(scan.since_ns);
    std::string text = "Frame " + std::to_string(times_.size()) + kEnd;
    for (std::size_t taxel = 0; taxel < layout_.size.taxels(); ++taxel) {
      const bool last = layout_.column({taxel}) + 1 == layout_.size.columns;
      text += value(scan, subject_.maps, taxel) + (last ? kEnd : ",");
    }
    file_.write(text + kEnd);
  }

  void finish() override {
    const std::size_t frames = times_.size();
    if (frames == 0)
      throw settings::InputError(path_ +
                                 ": there is no scan between --from and --until; choose a longer interval");
    const double span = 1e-9 * static_cast<double>(times_.back() - times_.front());
    std::string text = std::string("@@") + kEnd;
    for (std::size_t i = 0; i < frames; ++i) {
      text += "FRAME_TIME " + std::to_string(i + 1) + ' ' + secondsText(times_[i]) + kEnd;
      if (text.size() < kPiece) continue;
      file_.write(text);
      text.clear();
    }
    file_.write(text);
    const double period = frames > 1 ? span / static_cast<double>(frames - 1) : 0;
    file_.patch(period_at_, padded(settings::fixedText(period, 9)));
    file_.patch(end_frame_at_, padded(std::to_string(frames)));
    file_.finish();
  }

 private:
  std::string header(const ScanRecord& first) {
    const bool maps = subject_.maps;
    const double area = layout_.pitch_x * layout_.pitch_y * 1e6;
    std::string text;
    line("DATA_TYPE", "MOVIE", text);
    line("VERSION", "fsr_pressure_map " FSR_VERSION, text);
    line("FILENAME", subject_.name, text);
    line("SENSOR_TYPE", subject_.model.empty() ? subject_.sensor : subject_.model, text);
    line("ROWS", std::to_string(layout_.size.rows), text);
    line("COLS", std::to_string(layout_.size.columns), text);
    // With decimals also where they are zeros: readers look for a point (pressuRe::load_tekscan).
    line("ROW_SPACING", settings::fixedText(layout_.pitch_y * 1e3, 4) + " mm", text);
    line("COL_SPACING", settings::fixedText(layout_.pitch_x * 1e3, 4) + " mm", text);
    line("SENSEL_AREA", settings::fixedText(area, 4) + " mm2", text);
    line("NOISE_THRESHOLD", "0", text);
    text += "SECONDS_PER_FRAME ";
    period_at_ = text.size();
    text += padded("") + kEnd;
    line("TIME", date(first.stamp_ns), text);
    line("SCALE_FACTOR", "1", text);
    line("EXPONENT", "1", text);
    if (!maps) {
      line("SATURATION_PRESSURE", std::to_string(first.full_scale) + " RAW", text);
    } else if (!std::isnan(subject_.trained_high)) {
      line("SATURATION_PRESSURE", settings::roundedText(subject_.trained_high * 1e-3, 9) + " kPa", text);
      line("CALIBRATION_POINT_1", settings::roundedText(subject_.trained_low * 1e-3, 9) + " kPa", text);
      line("CALIBRATION_POINT_2", settings::roundedText(subject_.trained_high * 1e-3, 9) + " kPa", text);
    }
    if (maps) line("CALIBRATION_INFO", subject_.calibration + ' ' + subject_.scheme, text);
    line("UNITS", maps ? "kPa" : "RAW", text);
    line("MIRROR_ROW", "0", text);
    line("MIRROR_COL", "0", text);
    line("START_FRAME", "1", text);
    text += "END_FRAME ";
    end_frame_at_ = text.size();
    text += padded("") + kEnd;
    line("COMMENTS:",
         "research use, not for diagnosis or fitting decisions; TIME is UTC; B = no sensel or no reading",
         text);
    return text + "ASCII_DATA @@" + kEnd + kEnd;
  }

  void line(const std::string& key, const std::string& value, std::string& text) const {
    if (!value.empty()) text += key + ' ' + value + kEnd;
  }

  std::string path_;
  settings::FreshFile file_;
  ExportSubject subject_;
  matrix::Layout layout_;
  std::vector<std::int64_t> times_;  // of the frames, since the recording's first scan [ns]
  // Offsets in the header of numbers that are known only at the end [bytes].
  std::size_t end_frame_at_ = 0;
  std::size_t period_at_ = 0;
};

}  // namespace

std::unique_ptr<ScanSink> openTekscan(const std::string& output, const StatisticsOptions& /*options*/) {
  return std::make_unique<TekscanFile>(output);
}

}  // namespace fsr::exports
