#include "exports/video_file.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <map>
#include <sstream>
#include <vector>

#include "exports/exact_text.h"
#include "fsr_pressure_map/settings/input_error.h"

extern char** environ;

namespace fsr::exports {

namespace {

// ffmpeg's names of the formats, by file name ending.
const std::map<std::string, std::string>& formats() {
  static const std::map<std::string, std::string> kFormats = {
      {".mp4", "mp4"}, {".webm", "webm"}, {".mkv", "matroska"}, {".avi", "avi"}, {".gif", "gif"}};
  return kFormats;
}

std::string formatOf(const std::string& path) {
  const auto found = formats().find(std::filesystem::path(path).extension());
  if (found != formats().end()) return found->second;
  std::string endings;
  for (const auto& format : formats()) endings += ", " + format.first;
  throw settings::InputError(path + ": a movie's name must end with .png (animated, needs no other program)" +
                             endings);
}

std::vector<std::string> arguments(const std::string& format, const std::string& output,
                                   const view::Image& image, double rate) {
  const std::string size = std::to_string(image.width()) + "x" + std::to_string(image.height());
  std::vector<std::string> words = {"ffmpeg", "-nostdin",   "-loglevel",     "error", "-y",
                                    "-f",     "rawvideo",   "-pixel_format", "rgb24", "-video_size",
                                    size,     "-framerate", exactText(rate), "-i",    "pipe:0"};
  // Many players require even sides and this pixel format.
  if (format != "gif") {
    words.insert(words.end(), {"-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p"});
  }
  words.insert(words.end(), {"-f", format, output});
  return words;
}

std::string lastLine(const std::string& text) {
  std::istringstream lines(text);
  std::string last;
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty()) last = line;
  }
  return last;
}

}  // namespace

// A running ffmpeg.
class VideoFile::Encoder {
 public:
  explicit Encoder(const std::vector<std::string>& words) : old_handler_(std::signal(SIGPIPE, SIG_IGN)) {
    int in[2], err[2];
    if (::pipe2(in, O_CLOEXEC) != 0 || ::pipe2(err, O_CLOEXEC) != 0) fail(errno);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, in[0], STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, err[1], STDERR_FILENO);
    std::vector<char*> argv;
    for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    const int error = ::posix_spawnp(&process_, "ffmpeg", &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    ::close(in[0]);
    ::close(err[1]);
    input_ = in[1];
    messages_ = err[0];
    if (error != 0) fail(error);
  }
  ~Encoder() {
    wait();
    std::signal(SIGPIPE, old_handler_);
  }
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;

  // False if ffmpeg has ended.
  bool write(const std::vector<std::uint8_t>& bytes) {
    for (std::size_t done = 0; done < bytes.size();) {
      const ssize_t now = ::write(input_, bytes.data() + done, bytes.size() - done);
      if (now < 0 && errno == EINTR) continue;
      if (now <= 0) return false;
      done += static_cast<std::size_t>(now);
    }
    return true;
  }

  // Waits until ffmpeg has ended. Returns "" or the reason of its failure.
  std::string wait() {
    if (process_ <= 0) return complaint_;
    ::close(input_);
    std::string said;
    char part[1024];
    for (ssize_t size; (size = ::read(messages_, part, sizeof part)) > 0;) {
      said.append(part, static_cast<std::size_t>(size));
    }
    ::close(messages_);
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = -1;
    if (status != 0) complaint_ = "ffmpeg: " + (said.empty() ? "no reason given" : lastLine(said));
    return complaint_;
  }

 private:
  [[noreturn]] void fail(int error) {
    std::signal(SIGPIPE, old_handler_);
    throw settings::InputError(
        error == ENOENT ? "ffmpeg is not installed (Debian package ffmpeg); give --output NAME.png for an "
                          "animated PNG, which needs no other program"
                        : std::string("ffmpeg does not start: ") + std::strerror(error));
  }

  void (*old_handler_)(int);  // of SIGPIPE: writing to a program that has ended
  pid_t process_ = -1;
  int input_ = -1;
  int messages_ = -1;
  std::string complaint_;
};

VideoFile::VideoFile(const std::string& path, const PictureOptions& options)
    : PictureSink(options), path_(path), fresh_(path) {
  formatOf(path);
}

VideoFile::~VideoFile() = default;

// A movie has evenly spaced frames: the last picture is repeated until the time of the next one.
void VideoFile::picture(std::int64_t since_ns, const view::Image& image) {
  if (!encoder_) {
    encoder_ = std::make_unique<Encoder>(arguments(formatOf(path_), fresh_.name(), image, options().rate));
    first_ns_ = since_ns;
  }
  const std::int64_t due = std::llround(1e-9 * static_cast<double>(since_ns - first_ns_) * options().rate);
  for (; shown_ && frames_ < due; ++frames_) {
    if (!encoder_->write(shown_->bytes())) throw settings::InputError(path_ + ": " + encoder_->wait());
  }
  shown_ = image;
}

void VideoFile::finish() {
  const bool written = shown_ && encoder_->write(shown_->bytes());
  const std::string complaint = encoder_ ? encoder_->wait() : "holds no picture";
  if (!written || !complaint.empty()) throw settings::InputError(path_ + ": " + complaint);
  fresh_.finish();
}

}  // namespace fsr::exports
