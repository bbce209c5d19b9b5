// The file of a surface that was set:
//
//     format: fsr_pressure_map surface 1
//     launched_surface: flat       # what the launch file said
//     launched_mount: 1
//     surface: cylinder_7cm        # what ~set_surface said last
//     mount: 2
//     ended: false                 # true: the node was stopped; false: it runs, or it died

#include "ros/bags/surface_folder.h"

#include <filesystem>
#include <limits>

#include "matrix/surface_file.h"
#include "ros/bags/resource_path.h"
#include "settings/replace_file.h"
#include "settings/settings.h"
#include "settings/text.h"

namespace fsr_ros {

namespace fs = std::filesystem;

SurfaceFolder::SurfaceFolder(const std::string& folder, fsr::matrix::MatrixSize size)
    : folder_(resolveResource(folder)), size_(size) {}

std::string SurfaceFolder::pathOf(const std::string& surface) const {
  const bool is_path = surface.find('/') != std::string::npos;
  std::string path = is_path ? resolveResource(surface) : (fs::path(folder_) / (surface + ".yaml")).string();
  std::error_code error;
  if (!fs::exists(path, error)) {
    const std::string why = error ? " (" + error.message() + ")" : "",
                      known = fsr::settings::joined(fsr::matrix::surfacesIn(folder_));
    throw fsr::settings::InputError("surface " + surface + ": there is no file " + path + why +
                                    "; surfaces in " + folder_ + ": " + (known.empty() ? "none" : known));
  }
  return path;
}

fsr::matrix::Surface SurfaceFolder::load(const std::string& surface) const {
  return fsr::matrix::readSurfaceFile(pathOf(surface), size_);
}

std::optional<fsr::matrix::MeshPlace> SurfaceFolder::meshOf(const std::string& surface) const {
  return fsr::matrix::readMeshPlaceFile(pathOf(surface));
}

namespace {

namespace fs = std::filesystem;

constexpr char kSurfaceFormat[] = "fsr_pressure_map surface 1";
const fsr::settings::Range kMount{0, std::numeric_limits<std::uint32_t>::max(), ""};

}  // namespace

std::string LaidOn::text() const {
  return (surface.empty() ? "an unknown surface" : surface) + ", mount " + std::to_string(mount);
}

SurfaceMemory::SurfaceMemory(std::string path, const LaidOn& launched)
    : path_(std::move(path)), launched_(launched), start_(launched) {
  std::error_code none;
  if (!fs::is_regular_file(path_, none)) return;
  try {
    stored_ = load(path_);
  } catch (const fsr::settings::InputError& error) {
    remark_ = std::string("the last surface is not known: ") + error.what();
    return;
  }
  if (stored_->now == launched) return;
  if (!stored_->ended && stored_->launched == launched) {
    start_ = stored_->now;
    remark_ = "the node died and goes on with " + start_.text() + ", as it was told last, and not with " +
              launched.text() +
              " of the launch file; call ~set_surface if the matrix lies on another surface";
  } else {
    remark_ = "the launch file says " + launched.text() + ", but the matrix lay last on " +
              stored_->now.text() + "; the launch file is used: call ~set_surface if that is wrong";
  }
}

SurfaceMemory::Stored SurfaceMemory::load(const std::string& path) {
  const auto settings = fsr::settings::Settings::fromFile(path);
  settings.choice("format", {kSurfaceFormat});
  Stored stored;
  stored.launched.surface = settings.text("launched_surface");
  stored.launched.mount = static_cast<std::uint32_t>(settings.integer("launched_mount", kMount));
  stored.now.surface = settings.text("surface");
  stored.now.mount = static_cast<std::uint32_t>(settings.integer("mount", kMount));
  stored.ended = settings.flag("ended", false);
  settings.refuseUnknown();
  return stored;
}

void SurfaceMemory::keep(const LaidOn& now) {
  stored_ = Stored{launched_, now, false};
  save();
}

void SurfaceMemory::end() {
  if (!stored_ || stored_->ended) return;
  stored_->ended = true;
  save();
}

void SurfaceMemory::save() {
  std::error_code ignored;  // an error in the folder shows when the file is written
  fs::create_directories(fs::path(path_).parent_path(), ignored);
  using fsr::settings::quotedText;
  fsr::settings::replaceFile(path_, "format: " + std::string(kSurfaceFormat) +
                                        "\nlaunched_surface: " + quotedText(stored_->launched.surface) +
                                        "\nlaunched_mount: " + std::to_string(stored_->launched.mount) +
                                        "\nsurface: " + quotedText(stored_->now.surface) +
                                        "\nmount: " + std::to_string(stored_->now.mount) +
                                        "\nended: " + (stored_->ended ? "true" : "false") + "\n");
}

}  // namespace fsr_ros
