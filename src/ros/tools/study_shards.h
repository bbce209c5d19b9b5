#pragma once

#include <map>
#include <ostream>
#include <string>
#include <vector>

#include "report/shard_file.h"
#include "study/study_pieces.h"

namespace fsr_ros {

/// A shard of a study: where it is written and what must be alike in all shards.
struct StudyShard {
  fsr::report::Shard shard;
  std::string folder;
  std::map<std::string, std::string> options;  ///< besides the plan and the recordings

  /// The file that the shard writes last.
  std::string path() const;
};

/// Writes the pieces, and then the file of the shard. Throws InputError.
void writeStudyShard(const StudyShard& shard, const fsr::study::StudyParts& parts, std::ostream& out);

/// All pieces of the study, from the files of all of its shards. Throws InputError if they do not belong
/// together, with one sentence that names the file. The date is that of the first shard.
fsr::study::StudyParts readStudyShards(const std::vector<std::string>& paths);

}  // namespace fsr_ros
