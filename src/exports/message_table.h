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
///   single value        `stamp`  [messages]; texts of fixed length; times as int64 nanoseconds
///   array               `values` [messages x n]; [messages x rows x columns] if the message has fields of
///                       these names and the array has as many values
///   array whose length  `values` [values of all messages], `values.count` [messages]
///   differs
///   array of messages   their fields as above, with an entry for each element, and `array.count`
///
/// The attributes `unit` and `meaning` come from the comments of the message definition.
class MessageTableWriter {
 public:
  /// `survey` must be plain and must have seen every message that will be added.
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
  std::set<std::size_t> uniform_;  // arrays with one dataset row for each message
};

/// Restores the messages in the order in which they were added, byte for byte.
class MessageTableReader {
 public:
  /// Throws InputError if a dataset is missing or of another kind.
  MessageTableReader(hid_t file, const std::string& group, const MessageType& type);
  /// Appends the bytes of the next message. Throws InputError if there is none.
  void next(std::string& bytes);

 private:
  void open(hid_t file, const std::string& group, const std::vector<MessageField>& fields);
  void put(const std::vector<MessageField>& fields, std::string& bytes);
  void putValues(const MessageField& field, std::size_t count, std::string& bytes);

  const MessageType& type_;
  std::map<std::size_t, std::unique_ptr<hdf5::ColumnReader>> values_;
  std::map<std::size_t, std::unique_ptr<hdf5::ColumnReader>> counts_;
};

/// Unit and meaning of a field. The meaning is its comment in the message definition; the unit is the part in
/// brackets, as in "[Pa], row-major", or comes from a table of fields without one.
std::pair<std::string, std::string> unitAndMeaning(const std::string& type, const MessageField& field);

}  // namespace fsr::exports
