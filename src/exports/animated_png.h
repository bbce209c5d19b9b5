#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "exports/map_pictures.h"
#include "settings/fresh_file.h"

namespace fsr::exports {

/// A movie as an animated PNG (APNG, PNG specification, third edition). Browsers play it; other viewers show
/// the first picture. It needs no other program. It runs once, in real time.
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
  std::optional<std::pair<std::int64_t, std::string>> held_;  // last picture, until its duration is known
  std::uint32_t pictures_ = 0;
  std::uint32_t sequence_ = 0;  // number of the next chunk of the animation
  std::size_t control_at_ = 0;  // offset of the number of pictures [bytes]
};

}  // namespace fsr::exports
