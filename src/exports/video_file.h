#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "exports/map_pictures.h"
#include "settings/fresh_file.h"

namespace fsr::exports {

/// A movie that ffmpeg encodes in real time. The format follows from the name's ending: .mp4, .webm, .mkv,
/// .avi or .gif. ffmpeg is started without a shell and reads the pictures from a pipe.
class VideoFile : public PictureSink {
 public:
  /// Throws InputError for another ending.
  VideoFile(const std::string& path, const PictureOptions& options);
  ~VideoFile() override;

  /// Throws InputError if ffmpeg is not installed, or if it fails: then with the last line of its messages.
  void finish() override;

 private:
  class Encoder;
  void picture(std::int64_t since_ns, const view::Image& image) override;

  std::string path_;
  settings::FreshPath fresh_;
  std::unique_ptr<Encoder> encoder_;
  std::optional<view::Image> shown_;
  std::int64_t first_ns_ = 0;
  std::int64_t frames_ = 0;
};

}  // namespace fsr::exports
