#pragma once

#include <memory>
#include <string>

#include "exports/scan_formats.h"
#include "settings/replace_file.h"

namespace test_support {

/// A minimal export format outside the package: one line for each scan with time [s] and counts.
class LineFile : public fsr::exports::ScanSink {
 public:
  explicit LineFile(const std::string& path) : file_(path) {}

  void begin(const fsr::exports::ExportSubject& subject) override { file_.write("# " + subject.name + "\n"); }
  void add(const fsr::exports::ScanRecord& scan) override {
    std::string line = std::to_string(static_cast<double>(scan.since_ns) * 1e-9);
    for (const std::uint16_t counts : scan.counts) line += " " + std::to_string(counts);
    file_.write(line + "\n");
  }
  void finish() override { file_.finish(); }

 private:
  fsr::settings::FreshFile file_;
};

/// Its entry for the table of formats.
inline fsr::exports::ScanFormat lineFormat() {
  const auto open = [](const std::string& output, const fsr::exports::StatisticsOptions&) {
    return std::make_unique<LineFile>(output);
  };
  return {"lines", "one line for each scan: time [s] and counts", true, open};
}

}  // namespace test_support
