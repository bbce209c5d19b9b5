#include "ros/tools/study_shards.h"

#include <filesystem>

#include "fsr_pressure_map/settings/input_error.h"
#include "report/study/study_parts_file.h"
#include "settings/replace_file.h"
#include "settings/sha256.h"

namespace fsr_ros {

namespace {

namespace fs = std::filesystem;
using fsr::report::FoundShard;
using fsr::report::Shard;
using fsr::settings::InputError;
using fsr::study::StudyParts;

constexpr char kTool[] = "study";

std::string piecesFileName(const Shard& shard) {
  return "pieces_" + std::to_string(shard.number) + "_of_" + std::to_string(shard.of) + ".json";
}

// The recordings in their order, which changes the numbers.
void addRecordings(const StudyParts& parts, std::map<std::string, std::string>& options) {
  std::size_t number = 0;
  for (const fsr::calibration::SourceBag& bag : parts.frame.provenance.bags) {
    options["recording " + std::to_string(++number)] =
        bag.sha256.empty() ? bag.name : bag.name + " (SHA-256 " + bag.sha256 + ")";
  }
}

// Throws unless the pieces are those that the shard has to compute.
void requireOwnPieces(const std::string& path, const Shard& shard, const StudyParts& parts) {
  std::size_t own = 0;
  for (std::size_t i = 0; i < parts.pieces_of_study; ++i) own += shard.has(i);
  for (const auto& [number, piece] : parts.computed)
    if (!shard.has(number) || number >= parts.pieces_of_study) own = parts.computed.size() + 1;
  if (own != parts.computed.size())
    throw InputError(path + ": does not have the pieces of shard " + std::to_string(shard.number) + " of " +
                     std::to_string(shard.of) + "; run this shard again");
}

}  // namespace

std::string StudyShard::path() const {
  return fs::path(folder) / fsr::report::shardFileName(shard);
}

void writeStudyShard(const StudyShard& shard, const StudyParts& parts, std::ostream& out) {
  const std::string name = piecesFileName(shard.shard), content = fsr::report::studyPartsJson(parts);
  fsr::report::ShardFile file{kTool, {}, shard.shard, shard.options, {}};
  file.options.merge(fsr::report::studyOptions(parts.frame.plan));
  addRecordings(parts, file.options);
  file.files[name] = fsr::settings::sha256(content.data(), content.size());
  fsr::settings::replaceFile(fs::path(shard.folder) / name, content);
  fsr::settings::replaceFile(shard.path(), fsr::report::shardJson(file));
  out << parts.computed.size() << " of " << parts.pieces_of_study << " pieces of the study written to "
      << shard.path() << std::endl;
}

StudyParts readStudyShards(const std::vector<std::string>& paths) {
  StudyParts all;
  std::string first;
  for (const FoundShard& found : fsr::report::readShards(paths, kTool)) {
    const std::string path = fs::path(found.path).parent_path() / piecesFileName(found.file.shard);
    StudyParts parts = fsr::report::readStudyParts(path);
    requireOwnPieces(path, found.file.shard, parts);
    if (first.empty()) {
      first = path;
      all = std::move(parts);
    } else {
      fsr::report::addStudyParts(std::move(parts), path, first, all);
    }
  }
  return all;
}

}  // namespace fsr_ros
