#include "exports/message_table.h"

#include <array>
#include <cstring>

namespace fsr::exports {

using hdf5::ColumnWriter;

using hdf5::ColumnPlan;

using hdf5::ColumnReader;

using Count = MessageField::Count;

namespace {

constexpr char kCount[] = ".count";

bool isTime(Scalar scalar) {
  return scalar == Scalar::kTime || scalar == Scalar::kDuration;
}

// Type of the dataset; 0 for texts.
hid_t storedType(Scalar scalar) {
  switch (scalar) {
    case Scalar::kBool:
    case Scalar::kUint8:
      return H5T_NATIVE_UINT8;
    case Scalar::kInt8:
      return H5T_NATIVE_INT8;
    case Scalar::kInt16:
      return H5T_NATIVE_INT16;
    case Scalar::kUint16:
      return H5T_NATIVE_UINT16;
    case Scalar::kInt32:
      return H5T_NATIVE_INT32;
    case Scalar::kUint32:
      return H5T_NATIVE_UINT32;
    case Scalar::kUint64:
      return H5T_NATIVE_UINT64;
    case Scalar::kFloat32:
      return H5T_NATIVE_FLOAT;
    case Scalar::kFloat64:
      return H5T_NATIVE_DOUBLE;
    case Scalar::kString:
      return 0;
    default:
      return H5T_NATIVE_INT64;  // also times and durations
  }
}

// Whether the array has one dataset row for each message. Arrays of texts never have.
bool isUniform(const MessageField& field, const MessageSurvey& survey) {
  return !field.nested && field.scalar != Scalar::kString && field.count == Count::kAny &&
         survey.lengthOf(field).has_value();
}

bool exists(hid_t file, const std::string& path) {
  return H5Lexists(file, path.c_str(), H5P_DEFAULT) > 0;
}

}  // namespace

MessageTableWriter::MessageTableWriter(hid_t file, const std::string& group, const MessageType& type,
                                       const MessageSurvey& survey)
    : type_(type) {
  lay(file, group, type.fields, survey);
}

void MessageTableWriter::lay(hid_t file, const std::string& group, const std::vector<MessageField>& fields,
                             const MessageSurvey& survey) {
  for (const MessageField& field : fields) {
    ColumnPlan plan;
    plan.path = group + "/" + field.name;
    if (field.count == Count::kAny && !isUniform(field, survey)) {
      ColumnPlan counts;
      counts.path = plan.path + kCount;
      counts.type = H5T_NATIVE_UINT32;
      counts.meaning = "number of entries of " + field.name + " that belong to each message or array element";
      counts_[field.id] = std::make_unique<ColumnWriter>(file, counts);
    }
    if (field.nested) {
      lay(file, group, field.fields, survey);
    } else {
      layValues(file, plan, field, survey);
    }
  }
}

void MessageTableWriter::layValues(hid_t file, ColumnPlan plan, const MessageField& field,
                                   const MessageSurvey& survey) {
  plan.type = storedType(field.scalar);
  plan.text_size = survey.longestText(field);
  std::tie(plan.unit, plan.meaning) = unitAndMeaning(type_.name, field);
  if (field.count == Count::kFixed && field.scalar != Scalar::kString) plan.shape = {field.fixed};
  if (isUniform(field, survey)) {
    const std::size_t length = *survey.lengthOf(field);
    const std::size_t rows = survey.constant("rows").value_or(0);
    const std::size_t columns = survey.constant("columns").value_or(0);
    plan.shape = {length};
    if (length == rows * columns && length > 0) plan.shape = {rows, columns};
    uniform_.insert(field.id);
  }
  if (!plan.shape.empty() && plan.shape.front() == 0) return;  // the array is empty in every message
  values_[field.id] = std::make_unique<ColumnWriter>(file, plan);
}

// Appends the values of a message to the columns.
struct TableFiller {
  MessageTableWriter& table;

  void count(const MessageField& field, std::uint32_t n) {
    const auto column = table.counts_.find(field.id);
    if (column != table.counts_.end()) column->second->append(&n, 1);
  }
  void values(const MessageField& field, const char* bytes, std::size_t n) {
    if (n == 0) return;
    ColumnWriter& column = *table.values_.at(field.id);
    const bool whole = field.count == Count::kFixed || table.uniform_.count(field.id) > 0;
    if (!isTime(field.scalar)) return column.append(bytes, whole ? 1 : n);
    times_.clear();
    for (std::size_t i = 0; i < n; ++i) {
      bool usual = true;
      times_.push_back(nanosecondsOf(field.scalar, bytes + 8 * i, usual));
    }
    column.append(times_.data(), whole ? 1 : n);
  }
  void text(const MessageField& field, std::string_view text) {
    ColumnWriter& column = *table.values_.at(field.id);
    column.appendText(text);
  }

  std::vector<std::int64_t> times_;
};

void MessageTableWriter::add(std::string_view message) {
  TableFiller filler{*this, {}};
  visitMessage(type_, message, filler);
}

void MessageTableWriter::finish() {
  for (auto& column : values_) column.second->finish();
  for (auto& column : counts_) column.second->finish();
}

MessageTableReader::MessageTableReader(hid_t file, const std::string& group, const MessageType& type)
    : type_(type) {
  open(file, group, type.fields);
}

void MessageTableReader::open(hid_t file, const std::string& group, const std::vector<MessageField>& fields) {
  for (const MessageField& field : fields) {
    const std::string path = group + "/" + field.name;
    if (exists(file, path + kCount)) {
      counts_[field.id] = std::make_unique<ColumnReader>(file, path + kCount, H5T_NATIVE_UINT32);
    }
    if (field.nested) {
      open(file, group, field.fields);
    } else if (exists(file, path)) {
      values_[field.id] = std::make_unique<ColumnReader>(file, path, storedType(field.scalar));
    }
  }
}

void MessageTableReader::next(std::string& bytes) {
  put(type_.fields, bytes);
}

void MessageTableReader::put(const std::vector<MessageField>& fields, std::string& bytes) {
  for (const MessageField& field : fields) {
    std::size_t count = field.fixed;
    if (field.count == Count::kAny) {
      std::uint32_t length = 0;
      const auto counted = counts_.find(field.id);
      const auto values = values_.find(field.id);
      if (counted != counts_.end()) {
        std::memcpy(&length, counted->second->next(), sizeof(length));
      } else if (values != values_.end()) {
        length = static_cast<std::uint32_t>(values->second->width());
      }
      bytes.append(reinterpret_cast<const char*>(&length), sizeof(length));
      count = length;
    }
    if (!field.nested) {
      putValues(field, count, bytes);
    } else if (!field.fields.empty()) {
      for (; count > 0; --count) put(field.fields, bytes);
    }
  }
}

void MessageTableReader::putValues(const MessageField& field, std::size_t count, std::string& bytes) {
  if (count == 0) return;
  const auto found = values_.find(field.id);
  if (found == values_.end())
    throw settings::InputError("its table of " + type_.name + " has no " + field.name);
  ColumnReader& column = *found->second;
  if (field.scalar == Scalar::kString) {
    for (; count > 0; --count) {
      const std::string_view text = column.nextText();
      const auto length = static_cast<std::uint32_t>(text.size());
      bytes.append(reinterpret_cast<const char*>(&length), sizeof(length)).append(text);
    }
    return;
  }
  if (count % column.width() != 0)
    throw settings::InputError("its " + field.name + " has another number of values than it states");
  const char* values = column.next(count / column.width());
  if (!isTime(field.scalar)) {
    bytes.append(values, count * sizeOf(field.scalar));
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    std::int64_t nanoseconds = 0;
    std::memcpy(&nanoseconds, values + 8 * i, sizeof(nanoseconds));
    std::array<char, 8> time{};
    timeBytes(field.scalar, nanoseconds, time.data());
    bytes.append(time.data(), time.size());
  }
}

}  // namespace fsr::exports
