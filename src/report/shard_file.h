#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace fsr::report {

/// Part `number` of `of`: it has every of-th piece of the work, from the number-th on.
struct Shard {
  std::size_t number = 1;
  std::size_t of = 1;

  bool has(std::size_t piece) const { return piece % of == number - 1; }  ///< `piece` counts from 0
};

/// The shard of "2/4". Throws InputError unless 1 <= I <= N.
Shard readShard(const std::string& text);

/// What a shard writes about itself as its last step, so that one that was killed has none.
struct ShardFile {
  std::string tool;
  std::string version;  ///< of the package; empty = this one
  Shard shard;
  std::map<std::string, std::string> options;  ///< those that the result depends on
  std::map<std::string, std::string> files;    ///< SHA-256 of each file, by its path below the folder
};

/// "shard_2_of_4.json".
std::string shardFileName(const Shard& shard);
std::string shardJson(const ShardFile& file);

/// A shard's file, and where it is.
struct FoundShard {
  std::string path;
  ShardFile file;
};

/// The shards' files of a folder (shard_*.json). Throws InputError if there is none.
std::vector<std::string> shardsIn(const std::string& folder);

/// Reads shards, ordered by their number, and checks that they belong together: none missing, none there
/// twice, one tool, version, number of shards and set of options, and every file beside them as it was
/// written. Throws InputError with one sentence that names the file.
std::vector<FoundShard> readShards(const std::vector<std::string>& paths, const std::string& tool);

/// Checks the shards of a folder as readShards() does. Returns the number of files that they have written.
std::size_t checkShards(const std::string& folder, const std::string& tool);

}  // namespace fsr::report
