#include "fsr_pressure_map/calibration/calibration_file.h"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <tuple>

#include "calibration/file/calibration_hdf5.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "settings/foreign_error.h"
#include "settings/regular_file.h"
#include "settings/replace_file.h"
#include "settings/sha256.h"

namespace fsr::calibration {

namespace {

constexpr char kFormat[] = "fsr_pressure_map calibration";
constexpr std::size_t kIdDigits = 12;
// 32 x 32 taxels of 16 bit with six classes fit [bytes].
constexpr std::uintmax_t kLargestFile = std::uintmax_t{4} << 30;

// The user block: a line of text, filled up with zeros.
std::string userBlock(std::uint64_t schema, const std::string& hash) {
  std::string block = std::string(kFormat) + " schema=" + std::to_string(schema) + " sha256=" + hash + "\n";
  block.resize(hdf5::kUserBlock, '\0');
  return block;
}

// The schema that the user block names. Refuses a file that is not a calibration.
std::uint64_t schemaOf(const std::string& bytes) {
  if (bytes.empty()) throw settings::InputError("is empty; train again, or copy the file again");
  const std::string start = std::string(kFormat) + " schema=";
  if (bytes.compare(0, start.size(), start) != 0) {
    throw settings::InputError("is no calibration file; give one that train has written");
  }
  return std::strtoull(bytes.c_str() + start.size(), nullptr, 10);
}

// The user block. Of a file that is not a calibration nothing else is read.
std::string firstLine(const std::string& path) {
  settings::RegularFile file(path);
  std::string block(hdf5::kUserBlock, '\0');
  block.resize(file.read(block.data(), block.size()));
  schemaOf(block);
  if (file.size() > kLargestFile) throw settings::InputError("is larger than 4 GiB, which no calibration is");
  return block;
}

// The id. Refuses bytes that do not have the hash that the user block names. They are read piece by piece, so
// that a wrong file takes no memory, however large it is.
std::string verified(const std::string& path, const std::string& block, std::uint64_t schema) {
  const std::string hash = settings::sha256OfFile(path, hdf5::kUserBlock);
  if (block != userBlock(schema, hash) || hash == settings::sha256(nullptr, 0)) {
    throw settings::InputError(
        "is damaged or cut short: its bytes do not have the SHA-256 that its first line names; "
        "copy the file again or train again");
  }
  return hash.substr(0, kIdDigits);
}

struct VerifiedFile {
  std::uint64_t schema;
  std::string id;
};

// Reads a whole file. Refuses a schema that this version does not know.
VerifiedFile verifiedFile(const std::string& path) {
  const std::string block = firstLine(path);
  const std::uint64_t schema = schemaOf(block);
  const std::string has = "has schema " + std::to_string(schema) + ", but this version reads ";
  if (schema > kCalibrationSchema) {
    throw settings::InputError(has + "up to " + std::to_string(kCalibrationSchema) + "; update the package");
  }
  if (schema < kOldestSchema) {
    throw settings::InputError(has + std::to_string(kOldestSchema) + " to " +
                               std::to_string(kCalibrationSchema) + "; train again");
  }
  return {schema, verified(path, block, schema)};
}

// Properties that change when a file is replaced or written to: inode, time, size. Zeros if it does not
// exist.
using FileState = std::tuple<ino_t, time_t, long, off_t>;

FileState stateOf(const std::string& path) {
  struct stat state {};
  ::stat(path.c_str(), &state);
  return {state.st_ino, state.st_mtim.tv_sec, state.st_mtim.tv_nsec, state.st_size};
}

}  // namespace

std::string saveCalibration(const Calibration& calibration, const std::string& path) {
  settings::FreshPath fresh(path, settings::file_kind::kCalibration);
  errno = 0;
  try {
    hdf5::Writer writer(fresh.name());
    writeCalibration(calibration, writer);
    writer.finish();
  } catch (const settings::InputError&) {
    throw settings::cannotWrite(path, errno == 0 ? EIO : errno);
  }
  const std::string hash = settings::sha256OfFile(fresh.name(), hdf5::kUserBlock);
  const bool history = calibration.history.present() || calibration.temperature.present();
  const std::uint64_t schema = history ? kFirstSchemaWithHistory : kFirstSchemaWithRule;
  const std::string first_line = userBlock(schema, hash);
  std::fstream file(fresh.name(), std::ios::in | std::ios::out | std::ios::binary);
  if (!file.write(first_line.data(), static_cast<std::streamsize>(first_line.size())).flush()) {
    throw settings::cannotWrite(path, errno);
  }
  fresh.finish();
  return hash.substr(0, kIdDigits);
}

Calibration loadCalibration(const std::string& path, CalibrationParts parts,
                            const regression::RegressorTable* regressors) {
  try {
    const FileState before = stateOf(path);
    const VerifiedFile file = verifiedFile(path);
    Calibration calibration = readCalibration(hdf5::Reader(path), file.schema, parts, regressors);
    if (stateOf(path) != before) throw settings::InputError("was replaced while it was read; read it again");
    calibration.id = file.id;
    return calibration;
  } catch (const std::exception& error) {
    throw settings::sentenceAbout(path, error);
  }
}

}  // namespace fsr::calibration
