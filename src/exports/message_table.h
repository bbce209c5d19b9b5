#pragma once

#include <hdf5.h>

#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exports/message_survey.h"
#include "exports/message_type.h"
#include "hdf5/column.h"

// Only sources include this header: it needs HDF5's own.

namespace fsr::exports {

/// The messages of one topic as datasets, one for each field, in a group of the file:
///
///   a value             `stamp`  [messages]; texts of fixed length; times as int64 nanoseconds
///   an array            `values` [messages x n]; [messages x rows x columns] where the message has those
///   fields
///                       and the array has as many values
///   one whose length    `values` [all values, one message's after the other's], `values.count` [messages]
///   differs
///   messages in arrays  their fields as above with an entry for each of them, and `array.count`
///
/// The attributes `unit` and `meaning` are taken from the definition's comments.
class MessageTableWriter {
 public:
  /// `survey` has seen every message that will be added and is plain.
  MessageTableWriter(hid_t file, const std::string& group, const MessageType& type,
                     const MessageSurvey& survey);
  void add(std::string_view message);
  void finish();

 private:
  friend struct TableFiller;
  void lay(hid_t file, const std::string& group, const std::vector<MessageField>& fields,
           const MessageSurvey& survey);
  void layValues(hid_t file, hdf5::ColumnPlan plan, const MessageField& field, const MessageSurvey& survey);

  const MessageType& type_;
  std::map<std::size_t, std::unique_ptr<hdf5::ColumnWriter>> values_;  // by MessageField::id
  std::map<std::size_t, std::unique_ptr<hdf5::ColumnWriter>> counts_;
  std::set<std::size_t> uniform_;  // arrays that have one dataset row a message
};

/// Gives the messages back, in the order in which they were added, byte for byte.
class MessageTableReader {
 public:
  /// Throws InputError where a dataset is missing or of another kind.
  MessageTableReader(hid_t file, const std::string& group, const MessageType& type);
  /// Appends the next message's bytes; throws InputError behind the last.
  void next(std::string& bytes);

 private:
  void open(hid_t file, const std::string& group, const std::vector<MessageField>& fields);
  void put(const std::vector<MessageField>& fields, std::string& bytes);
  void putValues(const MessageField& field, std::size_t count, std::string& bytes);

  const MessageType& type_;
  std::map<std::size_t, std::unique_ptr<hdf5::ColumnReader>> values_;
  std::map<std::size_t, std::unique_ptr<hdf5::ColumnReader>> counts_;
};

/// Unit and meaning of a field of a message type: its comment, "[Pa], row-major", else what is known of the
/// types that come without. First the unit.
std::pair<std::string, std::string> unitAndMeaning(const std::string& type, const MessageField& field);

}  // namespace fsr::exports
