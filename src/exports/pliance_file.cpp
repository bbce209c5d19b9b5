#include <cmath>
#include <string>
#include <vector>

#include "exports/region_readings.h"
#include "exports/scan_formats.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "settings/number_text.h"
#include "settings/replace_file.h"

namespace fsr::exports {

namespace {

constexpr char kLineEnd[] = "\r\n";
constexpr std::size_t kTimesRoom = 100;  // space for the line of times [characters]

// Right-aligned in ten characters, as in the files of the format.
std::string column(const std::string& text) {
  return (text.size() < 9 ? std::string(9 - text.size(), ' ') : "") + ' ' + text;
}

std::string fixed(double value, int decimals) {
  return column(std::isnan(value) ? "NA" : settings::fixedText(value, decimals));
}

// Frames in the ASCII format of novel's pliance (*.asc), as a public file of it has them: a line of
// pressures [kPa] for each frame, a line of force [N] and centre of pressure [cm], and the corners of the
// sensors [cm]. Row 0 is at the top, where y is largest. Masked taxels are left out; NA = no reading, - = no
// contact.
class PlianceFile : public ScanSink {
 public:
  PlianceFile(const std::string& path, const StatisticsOptions& options)
      : path_(path), file_(path), reader_(options) {}

  void begin(const ExportSubject& subject) override {
    reader_.begin(subject);
    subject_ = subject;
  }

  void add(const ScanRecord& scan) override {
    const std::vector<RegionReading>& readings = reader_.read(scan);
    if (readings.empty()) return;
    const double time = 1e-9 * double(scan.since_ns);
    if (frames_ == 0) {
      layout_ = scan.layout;
      first_ = time;
      for (std::size_t i = 0; i < layout_.size.taxels(); ++i)
        if ((scan.map->flags[i] & map::taxel_flag::kMasked) == 0) sensors_.push_back(i);
      file_.write(header(scan));
    }
    requireOneSize(subject_, layout_.size, scan.layout.size, "a file of pliance has");
    std::string line = fixed(time, 5);
    for (const std::size_t taxel : sensors_) line += fixed(1e-3 * double(scan.map->pressure[taxel]), 3);
    file_.write(line + kLineEnd);
    const map::RegionStatistics& whole = readings.front().of;
    forces_ += fixed(time, 5) + fixed(whole.force, 3);
    // From the corner at the lower left; the matrix has its origin in the middle and y down the columns.
    const double width = layout_.pitch_x * layout_.size.columns, height = layout_.pitch_y * layout_.size.rows;
    forces_ += whole.centre ? fixed(1e2 * (whole.centre->x + width / 2), 3) +
                                  fixed(1e2 * (height / 2 - whole.centre->y), 3)
                            : column("-") + column("-");
    forces_ += kLineEnd;
    last_ = time;
    ++frames_;
  }

  void finish() override {
    if (frames_ == 0)
      throw settings::InputError(path_ +
                                 ": there is no map between --from and --until; choose a longer interval");
    file_.write(std::string(kLineEnd) + "time[secs]" + column("force[N]") + column("x[cm]") +
                column("y[cm]") + kLineEnd);
    file_.write(forces_ + kLineEnd + kLineEnd + corners());
    const double period = frames_ > 1 ? (last_ - first_) / double(frames_ - 1) : 0;
    std::string times = "total times [secs]: " + settings::fixedText(last_ - first_, 3) +
                        " time per frame [secs]: " + settings::fixedText(period, 6) +
                        " scanning rate [Hz]: " + settings::roundedText(period > 0 ? 1 / period : 0, 9);
    times.resize(kTimesRoom, ' ');
    file_.patch(times_at_, times);
    file_.finish();
  }

 private:
  std::string header(const ScanRecord& first) {
    std::string text =
        "file name: " + subject_.name + " date/time " + dateText(first.stamp_ns, "%d.%m.%y %H.%M") + kLineEnd;
    text += "mat type " + (subject_.model.empty() ? "fsr_pressure_map" : subject_.model) + kLineEnd;
    times_at_ = text.size();
    text +=
        std::string(kTimesRoom, ' ') + kLineEnd + "pressure values in kPa" + kLineEnd + kLineEnd + kLineEnd;
    text += std::string("electrical:") + kLineEnd + "time[secs]";
    for (const std::size_t taxel : sensors_) text += column(std::to_string(taxel + 1));
    return text + kLineEnd;
  }

  std::string corners() const {
    std::string text = "sensor";
    for (const std::size_t taxel : sensors_) text += column(std::to_string(taxel + 1));
    text += std::string(kLineEnd) + "corner[cm]" + kLineEnd;
    // Corner 0 is at the upper left; the others follow clockwise.
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const double right = corner == 1 || corner == 2, down = corner >= 2;
      std::string x = "x[" + std::to_string(corner) + "]", y = "y[" + std::to_string(corner) + "]";
      for (const std::size_t taxel : sensors_) {
        x += fixed(1e2 * layout_.pitch_x * (layout_.column({taxel}) + right), 4);
        y += fixed(1e2 * layout_.pitch_y * (layout_.size.rows - layout_.row({taxel}) - down), 4);
      }
      text += x + kLineEnd + y + kLineEnd;
    }
    return text;
  }

  std::string path_;
  settings::FreshFile file_;
  RegionReader reader_;
  ExportSubject subject_;
  matrix::Layout layout_;
  std::vector<std::size_t> sensors_;  // taxels that are written
  std::string forces_;                // the second block
  double first_ = 0, last_ = 0;       // time of the first and last frame [s]
  std::size_t frames_ = 0;
  std::size_t times_at_ = 0;  // offset in the header of what is known only at the end [bytes]
};

}  // namespace

std::unique_ptr<ScanSink> openPliance(const std::string& output, const StatisticsOptions& options) {
  return std::make_unique<PlianceFile>(output, options);
}

}  // namespace fsr::exports
