#include "blind/case_bags.h"

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>

#include "blind/case_files.h"
#include "ros/bags/bag_writer.h"
#include "settings/replace_file.h"

namespace blind {

namespace {

// Everything in the order of its stamps, as a recorder writes it.
void writeCaseBag(const std::string& path, const CaseBag& bag) {
  const fsr::dataset::Recording& recording = bag.recording;
  fsr_ros::BagWriter writer(path);
  fsr_pressure_map::MatrixInfo info;
  info.sensor_id = recording.sensor.sensor_id;
  info.serial = recording.sensor.serial;
  info.firmware = recording.sensor.firmware;
  info.sensor_model = recording.sensor.model;
  info.rows = recording.layout.size.rows;
  info.columns = recording.layout.size.columns;
  info.full_scale = recording.full_scale;
  info.pitch_x = static_cast<float>(recording.layout.pitch_x);
  info.pitch_y = static_cast<float>(recording.layout.pitch_y);
  info.ambient_pressure = kAmbientPressure;
  fsr_pressure_map::Session session;
  session.session_id = "blind";
  session.use = "chamber";
  session.mounted_on = "fixture";
  auto reference = bag.reference.begin();
  auto thermometer = bag.thermometer.begin();
  const auto upTo = [&](std::int64_t stamp) {
    for (; reference != bag.reference.end() && reference->first <= stamp; ++reference) {
      writer.addChamberPressure(reference->first, reference->second + kAmbientPressure, 0);
    }
    for (; thermometer != bag.thermometer.end() && thermometer->first <= stamp; ++thermometer) {
      writer.addTemperature(thermometer->first, thermometer->second);
    }
  };
  constexpr std::int64_t kSecond = 1000000000;  // [ns]
  std::int64_t described = 0;
  for (std::size_t i = 0; i < recording.scans(); ++i) {
    const std::int64_t stamp = recording.start_ns + std::llround(recording.time[i] * 1e9);
    upTo(stamp);
    const bool changed = i > 0 && recording.condition[i] != recording.condition[i - 1];
    if (i == 0 || changed || stamp - described >= kSecond) {
      writer.addMatrixInfo(stamp, info);
      writer.addSession(stamp, session);
      writer.addSurface(stamp, recording.conditions[recording.condition[i]]);
      described = stamp;
    }
    writer.addScan(
        stamp, bag.sequence[i],
        {recording.layout.size, recording.full_scale, recording.scan(i), recording.layout.size.taxels()});
  }
  upTo(std::numeric_limits<std::int64_t>::max());
  writer.close();
}

}  // namespace

void writeCase(const BlindCase& made, const std::string& output) {
  const std::filesystem::path folder(output);
  std::filesystem::create_directories(folder / "bags");
  for (const auto& entry : std::filesystem::directory_iterator(folder / "bags")) {
    if (entry.path().extension() == ".bag") std::filesystem::remove(entry.path());
  }
  for (const CaseBag& bag : made.bags) {
    writeCaseBag((folder / "bags" / bag.recording.name).string(), bag);
  }
  fsr::settings::replaceFile((folder / "key.yaml").string(), keyText(made));
}

}  // namespace blind
