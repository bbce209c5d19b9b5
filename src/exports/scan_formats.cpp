#include "exports/scan_formats.h"

#include <filesystem>

#include "exports/animated_png.h"
#include "exports/csv_table.h"
#include "exports/picture_folder.h"
#include "exports/scan_table.h"
#include "exports/tekscan_file.h"
#include "exports/video_file.h"
#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::exports {

namespace {

using Sink = std::unique_ptr<ScanSink>;

Sink openCsv(const std::string& output, const PictureOptions& /*pictures*/) {
  return std::make_unique<CsvTable>(output);
}

Sink openTekscan(const std::string& output, const PictureOptions& /*pictures*/) {
  if (std::filesystem::path(output).extension() == ".gz") {
    throw settings::InputError("--output is " + output + ", but only csv can be compressed");
  }
  return std::make_unique<TekscanFile>(output);
}

Sink openHdf5(const std::string& output, const PictureOptions& /*pictures*/) {
  return std::make_unique<ScanTable>(output);
}

Sink openPictures(const std::string& output, const PictureOptions& pictures) {
  return std::make_unique<PictureFolder>(output, pictures);
}

Sink openMovie(const std::string& output, const PictureOptions& pictures) {
  const std::filesystem::path ending = std::filesystem::path(output).extension();
  if (ending == ".png" || ending == ".apng") return std::make_unique<AnimatedPng>(output, pictures);
  return std::make_unique<VideoFile>(output, pictures);
}

ScanFormat table(const std::string& name, const std::string& summary, bool several_recordings,
                 Sink (*open)(const std::string&, const PictureOptions&)) {
  return {name, summary, several_recordings, false, open};
}

ScanFormat drawn(const std::string& name, const std::string& summary,
                 Sink (*open)(const std::string&, const PictureOptions&)) {
  return {name, summary, false, true, open};
}

}  // namespace

const std::vector<ScanFormat>& scanFormats() {
  static const std::vector<ScanFormat> formats = {
      table("csv", "table with a row for each taxel and scan (.gz: compressed); takes several bags", true,
            openCsv),
      table("hdf5", "datasets with an entry for each scan (h5py, MATLAB, R)", false, openHdf5),
      table("tekscan", "ASCII as Tekscan's I-Scan and F-Scan save it (*.asf)", false, openTekscan),
      drawn("png", "a picture of each map, in a new folder", openPictures),
      drawn("movie", "NAME.png (animated PNG), or .mp4 .webm .mkv .avi .gif (written by ffmpeg)", openMovie)};
  return formats;
}

}  // namespace fsr::exports
