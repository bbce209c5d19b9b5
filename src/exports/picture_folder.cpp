#include "exports/picture_folder.h"

#include <array>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "fsr_pressure_map/settings/input_error.h"
#include "settings/replace_file.h"

namespace fsr::exports {

namespace {

// Refuses an existing path. Checked before FreshPath is made, whose message is less clear.
std::string newFolder(const std::string& path) {
  if (std::filesystem::exists(path)) {
    throw settings::InputError(path + ": exists already; give the name of a new folder with --output");
  }
  return path;
}

}  // namespace

PictureFolder::PictureFolder(const std::string& path, const PictureOptions& options)
    : PictureSink(options), path_(newFolder(path)), fresh_(path) {
  std::error_code error;
  if (!std::filesystem::create_directory(fresh_.name(), error))
    throw settings::cannotWrite(path, error.value());
}

void PictureFolder::picture(std::int64_t /*since_ns*/, const view::Image& image) {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "/map_%06zu.png", ++pictures_);
  const std::string bytes = view::pngOf(image);
  std::ofstream file(fresh_.name() + name.data(), std::ios::binary);
  errno = 0;
  if (!file.write(bytes.data(), static_cast<std::streamsize>(bytes.size())).flush()) {
    throw settings::cannotWrite(path_, errno != 0 ? errno : EIO);
  }
}

void PictureFolder::finish() {
  fresh_.finish();
}

}  // namespace fsr::exports
