#include "report/shard_file.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "fsr_pressure_map/settings/input_error.h"
#include "report/result_json.h"
#include "settings/sha256.h"

namespace fsr::report {

namespace {

namespace fs = std::filesystem;
using settings::InputError;

std::string nameOf(const Shard& shard) {
  return "shard " + std::to_string(shard.number) + " of " + std::to_string(shard.of);
}

FoundShard read(const std::string& path) {
  if (!fs::is_regular_file(path)) throw InputError(path + ": there is no such file");
  FoundShard found{path, {}};
  try {
    const auto data = nlohmann::json::parse(std::ifstream(path));
    ShardFile& file = found.file;
    data.at("tool").get_to(file.tool);
    data.at("version").get_to(file.version);
    data.at("shard").get_to(file.shard.number);
    data.at("of").get_to(file.shard.of);
    data.at("options").get_to(file.options);
    data.at("files").get_to(file.files);
  } catch (const nlohmann::json::exception&) {
    throw InputError(path + ": cannot be read as the file of a shard; run this shard again");
  }
  if (found.file.shard.number < 1 || found.file.shard.number > found.file.shard.of)
    throw InputError(path + ": is " + nameOf(found.file.shard) + ", which cannot be; run this shard again");
  return found;
}

void requireEqual(const std::string& what, const std::string& first, const std::string& other,
                  const std::vector<FoundShard>& all, const FoundShard& one) {
  if (first == other) return;
  throw InputError(one.path + ": " + what + " is " + other + " here and " + first + " in " +
                   all.front().path + "; run all shards with the same");
}

void refuseDifferences(const std::vector<FoundShard>& all, const std::string& tool) {
  const ShardFile& first = all.front().file;
  for (const FoundShard& one : all) {
    if (one.file.tool != tool)
      throw InputError(one.path + ": is a shard of " + one.file.tool + ", but must be one of " + tool);
    requireEqual("the version", first.version, one.file.version, all, one);
    requireEqual("the number of shards", std::to_string(first.shard.of), std::to_string(one.file.shard.of),
                 all, one);
    std::map<std::string, std::string> here = one.file.options, there = first.options;
    for (const auto& option : first.options) here.insert({option.first, "missing"});
    for (const auto& option : here) there.insert({option.first, "missing"});
    for (const auto& [name, value] : here) requireEqual(name, there[name], value, all, one);
  }
}

std::string folderOf(const FoundShard& one) {
  const fs::path folder = fs::path(one.path).parent_path();
  return folder.empty() ? "." : folder;
}

// Every file of the shard is beside it, as it was written.
void refuseOtherFiles(const FoundShard& one) {
  for (const auto& [name, sum] : one.file.files) {
    const std::string path = fs::path(folderOf(one)) / name;
    if (!fs::is_regular_file(path))
      throw InputError(path + ": is missing, but " + one.path +
                       " has it; copy the folders of all shards into one");
    if (settings::sha256OfFile(path) != sum)
      throw InputError(path + ": is not the file that " + one.path + " says (SHA-256 " + sum +
                       "); run this shard again");
  }
}

void refuseDoubles(const std::vector<FoundShard>& all) {
  std::map<std::size_t, std::string> shards;
  std::map<std::string, std::string> files;
  for (const FoundShard& one : all) {
    const auto [shard, is_new] = shards.insert({one.file.shard.number, one.path});
    if (!is_new)
      throw InputError(one.path + ": is " + nameOf(one.file.shard) + ", and so is " + shard->second +
                       "; remove one of them");
    for (const auto& file : one.file.files) {
      const auto [written, first_time] = files.insert({file.first, one.path});
      if (!first_time)
        throw InputError(one.path + ": has " + file.first + ", and so has " + written->second +
                         "; run both shards again");
    }
  }
}

void refuseGaps(const std::vector<FoundShard>& all) {
  const std::string folder = folderOf(all.front());
  std::set<std::size_t> there;
  for (const FoundShard& one : all) there.insert(one.file.shard.number);
  for (Shard shard{1, all.front().file.shard.of}; shard.number <= shard.of; ++shard.number) {
    if (there.count(shard.number) > 0) continue;
    throw InputError(folder + ": " + nameOf(shard) + " is missing; run it with --shard " +
                     std::to_string(shard.number) + "/" + std::to_string(shard.of));
  }
}

}  // namespace

Shard readShard(const std::string& text) {
  static const std::regex form("([0-9]{1,6})/([0-9]{1,6})");
  std::smatch match;
  if (std::regex_match(text, match, form)) {
    const Shard shard{std::stoul(match[1]), std::stoul(match[2])};
    if (shard.number >= 1 && shard.number <= shard.of) return shard;
  }
  throw InputError("--shard is " + text + ", but must be I/N with 1 <= I <= N, e.g. 2/4");
}

std::string shardFileName(const Shard& shard) {
  return "shard_" + std::to_string(shard.number) + "_of_" + std::to_string(shard.of) + ".json";
}

std::string shardJson(const ShardFile& file) {
  return dump(Json{{"tool", file.tool},
                   {"version", file.version.empty() ? FSR_VERSION : file.version},
                   {"shard", file.shard.number},
                   {"of", file.shard.of},
                   {"options", file.options},
                   {"files", file.files}});
}

std::vector<std::string> shardsIn(const std::string& folder) {
  std::vector<std::string> paths;
  if (fs::is_directory(folder)) {
    for (const auto& entry : fs::directory_iterator(folder)) {
      const std::string name = entry.path().filename();
      if (name.rfind("shard_", 0) == 0 && entry.path().extension() == ".json") paths.push_back(entry.path());
    }
  }
  if (paths.empty())
    throw InputError(folder + ": holds no shard_I_of_N.json; run the shards with --shard I/N first");
  return paths;
}

std::vector<FoundShard> readShards(const std::vector<std::string>& paths, const std::string& tool) {
  std::vector<FoundShard> all;
  for (const std::string& path : paths) all.push_back(read(path));
  std::sort(all.begin(), all.end(), [](const FoundShard& a, const FoundShard& b) { return a.path < b.path; });
  refuseDifferences(all, tool);
  refuseDoubles(all);
  refuseGaps(all);
  for (const FoundShard& one : all) refuseOtherFiles(one);
  std::sort(all.begin(), all.end(), [](const FoundShard& a, const FoundShard& b) {
    return a.file.shard.number < b.file.shard.number;
  });
  return all;
}

std::size_t checkShards(const std::string& folder, const std::string& tool) {
  std::size_t number = 0;
  for (const FoundShard& one : readShards(shardsIn(folder), tool)) number += one.file.files.size();
  return number;
}

}  // namespace fsr::report
