#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "exports/map_pictures.h"
#include "settings/fresh_file.h"

namespace fsr::exports {

/// A movie as an animated PNG (APNG, PNG specification third edition): browsers play it, other viewers show
/// its first picture, and nothing but zlib is needed to make it. It runs in the recording's own time, once.
class AnimatedPng : public PictureSink {
 public:
  AnimatedPng(const std::string& path, const PictureOptions& options) : PictureSink(options), file_(path) {}

  void finish() override;

 private:
  void picture(std::int64_t since_ns, const view::Image& image) override;
  void writeHead(const std::string& png);
  void writeHeld(double seconds);
  void writeChunk(const char* type, const std::string& data);

  settings::FreshFile file_;
  std::uint32_t width_ = 0, height_ = 0;                      // [pixels]
  std::optional<std::pair<std::int64_t, std::string>> held_;  // until it is known how long it is shown
  std::uint32_t pictures_ = 0;
  std::uint32_t sequence_ = 0;  // of the chunks that belong to the animation
  std::size_t control_at_ = 0;  // where the number of pictures stands
};

}  // namespace fsr::exports
