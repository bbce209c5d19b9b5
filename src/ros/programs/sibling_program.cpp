#include "ros/programs/sibling_program.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <boost/process/args.hpp>
#include <boost/process/extend.hpp>
#include <boost/process/io.hpp>
#include <boost/process/start_dir.hpp>
#include <csignal>
#include <filesystem>
#include <fstream>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr_ros {

namespace {

namespace process = boost::process;
constexpr int kLessUrgent = 5;  // niceness: the driver and the conductor come first
constexpr int kMostFiles = 1024;

// In the new process, before it becomes the program. Sockets and bags of this process are not for it.
void prepare() {
  for (int file = STDERR_FILENO + 1; file < kMostFiles; ++file) ::fcntl(file, F_SETFD, FD_CLOEXEC);
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  [[maybe_unused]] const int niceness = ::nice(kLessUrgent);
}

}  // namespace

std::string siblingProgram(const std::string& name) {
  std::error_code failed;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", failed);
  const std::filesystem::path path = self.parent_path() / name;
  if (failed || !std::filesystem::exists(path))
    throw fsr::settings::InputError(path.string() + ": there is no such program; install the package again");
  return path.string();
}

process::child startProgram(const std::string& path, const std::vector<std::string>& arguments,
                            const ProgramFiles& files) {
  std::error_code failed;
  process::child program(path, process::args(arguments), process::start_dir(files.folder),
                         (process::std_in < process::null), (process::std_out > files.output),
                         (process::std_err > files.errors), failed,
                         process::extend::on_exec_setup([](auto&) { prepare(); }));
  if (failed) throw fsr::settings::InputError(path + ": cannot be started: " + failed.message());
  return program;
}

std::string whyItFailed(const process::child& program, const std::string& errors) {
  const int status = program.native_exit_code();
  if (WIFSIGNALED(status)) return "it was ended by signal " + std::to_string(WTERMSIG(status));
  if (program.exit_code() == 0) return "";
  std::ifstream file(errors);
  std::string line, last;
  while (std::getline(file, line)) {
    if (!line.empty()) last = line;
  }
  return last.empty() ? "exit status " + std::to_string(program.exit_code()) : last;
}

}  // namespace fsr_ros
