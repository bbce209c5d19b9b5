#pragma once

#include <string>

#include "exports/map_pictures.h"
#include "settings/fresh_file.h"

namespace fsr::exports {

/// PNG files map_000001.png, map_000002.png ... in a new folder. The folder appears when all files are
/// complete.
class PictureFolder : public PictureSink {
 public:
  /// Throws InputError if a file or folder of that name exists.
  PictureFolder(const std::string& path, const PictureOptions& options);

  void finish() override;

 private:
  void picture(std::int64_t since_ns, const view::Image& image) override;

  std::string path_;
  settings::FreshPath fresh_;
  std::size_t pictures_ = 0;
};

}  // namespace fsr::exports
