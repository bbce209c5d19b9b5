#include "hdf5/members.h"

#include "fsr_pressure_map/settings/input_error.h"
#include "settings/number_text.h"
#include "settings/text.h"

namespace fsr::hdf5 {

bool Members::group(const std::string& path, bool present) {
  group_ = path == "/" ? "" : path;
  if (group_.empty()) return true;
  if (reads()) return reader_->has(path);
  if (present) writer_->group(path);
  return present;
}

void Members::note(const std::string& name, const std::string& text) {
  if (!reads()) writer_->attribute(group_.empty() ? "/" : group_, name, text);
}

void Members::attribute(const std::string& name, std::string& text) {
  note(name, text);
  if (reads()) text = reader_->text(group_.empty() ? "/" : group_, name);
}

void Members::attribute(const std::string& name, double& value) {
  numbers(name, std::tie(value));
}

void Members::attribute(const std::string& name, std::uint64_t& value) {
  const std::string object = group_.empty() ? "/" : group_;
  if (reads()) {
    value = reader_->integer(object, name);
  } else {
    writer_->attribute(object, name, value);
  }
}

void Members::attribute(const std::string& name, bool& value) {
  std::uint64_t number = value ? 1 : 0;
  attribute(name, number);
  value = number != 0;
}

void Members::numberList(const std::string& name, std::vector<double>& values) {
  const std::string object = group_.empty() ? "/" : group_;
  if (reads()) {
    values = reader_->numbers(object, name, values.size());
  } else {
    writer_->attribute(object, name, values);
  }
}

void Members::texts(const std::string& name, std::vector<std::string>& texts, const std::string& meaning) {
  if (reads()) {
    texts = reader_->texts(path(name));
  } else {
    writer_->texts(path(name), texts, meaning);
  }
}

void Members::within(const std::string& name, const std::vector<double>& values, double low,
                     double high) const {
  if (!reads()) return;
  for (const double value : values) {
    if (value >= low && value <= high) continue;
    refuse(name, "has a value of " + settings::numberText(value) + ", but all must be " +
                     settings::roundedText(low) + " to " + settings::roundedText(high));
  }
}

void Members::refuse(const std::string& name, const std::string& what) const {
  throw settings::InputError("its " + path(name) + " " + what);
}

void Members::requireLength(const std::string& name, std::size_t found, std::size_t expected) const {
  if (found != expected)
    refuse(name, "has " + std::to_string(found) + " values, but must have " + std::to_string(expected));
}

}  // namespace fsr::hdf5
