#include "settings/regular_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

namespace fsr::settings {

namespace {

// "16 MiB", or bytes where it is less than one.
std::string sizeText(std::uint64_t bytes) {
  return bytes >> 20 > 0 ? std::to_string(bytes >> 20) + " MiB" : std::to_string(bytes) + " bytes";
}

InputError unreadable(const std::string& path, int error) {
  if (error == ENOENT) return InputError(path + ": there is no such file");
  return InputError(path + ": cannot be opened (" + std::strerror(error) +
                    "); give the path of a file that may be read");
}

}  // namespace

RegularFile::RegularFile(const std::string& path, std::uint64_t largest)
    : path_(path), descriptor_(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC)) {
  if (descriptor_ < 0) throw unreadable(path, errno);
  struct stat found {};
  const int error = ::fstat(descriptor_, &found) == 0 ? 0 : errno;
  size_ = static_cast<std::uint64_t>(found.st_size);
  if (error == 0 && S_ISREG(found.st_mode) && size_ <= largest) return;
  ::close(descriptor_);
  if (error != 0) throw unreadable(path, error);
  if (S_ISDIR(found.st_mode)) throw InputError(path + ": is a folder; give the path of a file");
  if (!S_ISREG(found.st_mode)) throw InputError(path + ": is a device or a pipe; give the path of a file");
  throw InputError(path + ": has " + sizeText(size_) + ", but a file of this kind has " + sizeText(largest) +
                   " at most; is it the right file?");
}

RegularFile::~RegularFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::size_t RegularFile::read(void* bytes, std::size_t size) {
  std::size_t done = 0;
  while (done < size) {
    const ssize_t now = ::read(descriptor_, static_cast<char*>(bytes) + done, size - done);
    if (now < 0 && errno == EINTR) continue;
    if (now < 0) throw InputError(path_ + ": cannot be read (" + std::strerror(errno) + ")");
    if (now == 0) break;
    done += static_cast<std::size_t>(now);
  }
  return done;
}

std::string RegularFile::rest() {
  std::string bytes(size_, '\0');
  bytes.resize(read(bytes.data(), bytes.size()));
  return bytes;
}

int RegularFile::release() {
  return std::exchange(descriptor_, -1);
}

void requireRegularFile(const std::string& path, std::uint64_t largest) {
  const RegularFile throws_if_not(path, largest);
}

namespace {

constexpr std::size_t kLookedAt = 1 << 16;  // [bytes]; the remarks at the head of a YAML file are shorter

struct Beginning {
  std::string_view bytes;
  const char* kind;
};

constexpr std::array<Beginning, 16> kBeginnings = {{
    {"#ROSBAG V", file_kind::kBag},
    {"fsr_pressure_map calibration ", file_kind::kCalibration},
    {"fsr_pressure_map archive ", "an archive of a bag"},
    {"\x89HDF", "an HDF5 file"},
    {"\x89PNG", file_kind::kPicture},
    {"GIF8", "a movie (gif)"},
    {"RIFF", "a movie (avi)"},
    {"\x1a\x45\xdf\xa3", "a movie (webm, mkv)"},
    {"\x1f\x8b", file_kind::kCompressed},
    {"PK", "a packed file (zip, xlsx)"},
    {"%PDF", "a PDF file"},
    {"DATA_TYPE", "a Tekscan file"},
    {"<", file_kind::kPage},
    {"{", file_kind::kJson},
    {"[", file_kind::kJson},
    {"solid ", "a mesh (STL)"},
}};

// The first line that is no remark.
std::string_view firstLine(std::string_view text) {
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    if (!line.empty() && line.front() != '#' && line != "---" && line != "\r") return line;
    text.remove_prefix(std::min(text.size(), line.size() + 1));
  }
  return {};
}

// "a YAML file of the kind plan", or empty for a line without a key.
std::string kindOfYaml(std::string_view line) {
  std::size_t end = 0;
  while (end < line.size() && (std::isalnum(static_cast<unsigned char>(line[end])) != 0 || line[end] == '_'))
    ++end;
  const std::string_view rest = line.substr(end);
  if (end == 0 || rest.empty() || rest.front() != ':' || (rest.size() > 1 && rest[1] != ' ')) return "";
  const std::string_view format = "format: fsr_pressure_map ";
  if (line.substr(0, format.size()) != format)
    return "a YAML file of the kind " + std::string(line.substr(0, end));
  line.remove_prefix(sizeof("format: ") - 1);
  return "a " + std::string(line.substr(0, line.find_last_of(' ')));  // without the version
}

}  // namespace

std::string kindOf(std::string_view beginning) {
  if (beginning.empty()) return "";
  for (const Beginning& known : kBeginnings) {
    if (beginning.substr(0, known.bytes.size()) == known.bytes) return known.kind;
  }
  if (beginning.substr(0, kLookedAt).find('\0') != std::string_view::npos) {
    return beginning.substr(std::min<std::size_t>(4, beginning.size()), 4) == "ftyp"
               ? "a movie (mp4)"
               : "a file of an unknown kind";
  }
  const std::string_view line = firstLine(beginning.substr(0, kLookedAt));
  const std::string yaml = kindOfYaml(line);
  if (!yaml.empty()) return yaml;
  return line.find(',') != std::string_view::npos ? file_kind::kTable : "a text";
}

std::string kindOfFile(const std::string& path) {
  std::string bytes(kLookedAt, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return kindOf(std::string_view(bytes).substr(0, static_cast<std::size_t>(file.gcount())));
}

}  // namespace fsr::settings
