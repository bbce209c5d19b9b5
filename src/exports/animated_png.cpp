#include "exports/animated_png.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>

namespace fsr::exports {

namespace {

constexpr std::size_t kSignature = 8;     // length of the signature [bytes]
constexpr std::size_t kHeader = 12 + 13;  // IHDR with length, type and checksum [bytes]
constexpr double kLongest = 65.0;         // longest time that a picture can be shown [s]

// Most significant byte first, as PNG requires.
std::string number(std::uint32_t value) {
  return {static_cast<char>(value >> 24), static_cast<char>(value >> 16), static_cast<char>(value >> 8),
          static_cast<char>(value)};
}

std::string shortNumber(std::uint32_t value) {
  return number(value).substr(2);
}

std::uint32_t numberAt(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<std::uint8_t>(bytes[at + i]);
  return value;
}

std::string chunk(const std::string& type, const std::string& data) {
  const std::string checked = type + data;
  const auto sum =
      ::crc32(0, reinterpret_cast<const Bytef*>(checked.data()), static_cast<uInt>(checked.size()));
  return number(static_cast<std::uint32_t>(data.size())) + checked + number(static_cast<std::uint32_t>(sum));
}

// Calls take(type, data) for each chunk of a PNG file.
template <typename Take>
void forEachChunk(const std::string& png, Take take) {
  for (std::size_t at = kSignature; at + 12 <= png.size();) {
    const std::size_t size = numberAt(png, at);
    take(png.substr(at + 4, 4), png.substr(at + 8, size));
    at += size + 12;
  }
}

// Chunk with the number of pictures; they are played once.
std::string control(std::uint32_t pictures) {
  return chunk("acTL", number(pictures) + number(1));
}

}  // namespace

void AnimatedPng::picture(std::int64_t since_ns, const view::Image& image) {
  std::string png = view::pngOf(image);
  if (!held_) {
    width_ = static_cast<std::uint32_t>(image.width());
    height_ = static_cast<std::uint32_t>(image.height());
    writeHead(png);
  } else {
    writeHeld(1e-9 * static_cast<double>(since_ns - held_->first));
  }
  held_.emplace(since_ns, std::move(png));
}

void AnimatedPng::writeHead(const std::string& png) {
  const std::string head = png.substr(0, kSignature + kHeader);
  file_.write(head + control(0));
  control_at_ = head.size();
}

// The first picture is in IDAT, where viewers without animation find it; the others are in fdAT.
void AnimatedPng::writeHeld(double seconds) {
  const auto shown = static_cast<std::uint32_t>(std::lround(1000 * std::clamp(seconds, 0.001, kLongest)));
  writeChunk("fcTL", number(sequence_++) + number(width_) + number(height_) + number(0) + number(0) +
                         shortNumber(shown) + shortNumber(1000) + std::string(2, '\0'));
  const bool first = pictures_++ == 0;
  forEachChunk(held_->second, [&](const std::string& type, const std::string& data) {
    if (type != "IDAT") return;
    if (first) {
      writeChunk("IDAT", data);
    } else {
      writeChunk("fdAT", number(sequence_++) + data);
    }
  });
}

void AnimatedPng::writeChunk(const char* type, const std::string& data) {
  file_.write(chunk(type, data));
}

void AnimatedPng::finish() {
  if (held_) writeHeld(1 / options().rate);
  writeChunk("IEND", "");
  file_.patch(control_at_, control(pictures_));
  file_.finish();
}

}  // namespace fsr::exports
