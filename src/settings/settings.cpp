#include "settings/settings.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "fsr_pressure_map/settings/range.h"
#include "settings/regular_file.h"
#include "settings/text.h"

namespace fsr::settings {

std::string Range::text() const {
  std::ostringstream out;
  out.precision(10);  // 12000000 baud, not 1.2e+07
  const bool bounded_low = std::isfinite(low);
  const bool bounded_high = std::isfinite(high);
  if (bounded_low && bounded_high) {
    out << low << " to " << high;
  } else if (bounded_low) {
    out << low;
  } else if (bounded_high) {
    out << high;
  } else {
    out << "any number";
  }
  if (!unit.empty()) out << ' ' << unit;
  if (bounded_low && !bounded_high) out << " or more";
  if (!bounded_low && bounded_high) out << " or less";
  return out.str();
}

struct Settings::Node {
  YAML::Node yaml;
  std::string origin;  // the file
  std::string path;    // dotted path of this mapping inside it, "" at the top
  mutable std::set<std::string> known;
  mutable std::vector<std::shared_ptr<Node>> opened;  // sections that were read from this one

  std::string field(const std::string& key) const { return path.empty() ? key : path + "." + key; }
};

namespace {

// A surface of 64 x 64 taxels takes 256 KiB. Each byte of a list of digits takes 230 bytes of memory [bytes].
constexpr std::uint64_t kLargestFile = 2 << 20;

// A long text, e.g. a file of another kind, by its beginning.
std::string oneLine(const YAML::Node& node) {
  constexpr std::size_t kLongest = 80;  // [bytes]
  if (node.IsScalar())
    return node.Scalar().size() > kLongest ? node.Scalar().substr(0, kLongest) + "..." : node.Scalar();
  if (node.IsSequence()) return "a list of " + std::to_string(node.size());
  if (node.IsMap()) return "a mapping";
  return "empty";
}

// yaml-cpp silently keeps the last of two equal keys; here a duplicate key is an error. So is a key that is a
// list or a mapping, which YAML permits.
void refuseBadKeys(const YAML::Node& mapping, const std::string& origin, const std::string& path) {
  std::set<std::string> seen;
  for (const auto& entry : mapping) {
    if (!entry.first.IsScalar()) {
      throw InputError(origin + ": a key" + (path.empty() ? "" : " of " + path) + " is " +
                       oneLine(entry.first) + ", but must be a name");
    }
    const std::string& key = entry.first.Scalar();
    if (!seen.insert(key).second) {
      throw InputError(origin + ": " + (path.empty() ? key : path + "." + key) + " is given twice; keep one");
    }
  }
}

}  // namespace

Settings::Settings(std::shared_ptr<Node> node) : node_(std::move(node)) {
  refuseBadKeys(node_->yaml, node_->origin, node_->path);
}

static YAML::Node topMapping(const std::string& origin, const YAML::Node& yaml) {
  if (!yaml.IsMap()) {
    throw InputError(origin + ": the file is " + oneLine(yaml) +
                     ", but a YAML mapping of settings is expected");
  }
  return yaml;
}

Settings Settings::fromFile(const std::string& path) {
  return fromText(RegularFile(path, kLargestFile).rest(), path);
}

Settings Settings::fromText(const std::string& text, const std::string& origin) {
  YAML::Node yaml;
  try {
    yaml = YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw InputError(origin + ": not valid YAML: " + error.what());
  }
  return Settings(std::make_shared<Node>(Node{topMapping(origin, yaml), origin, "", {}, {}}));
}

bool Settings::has(const std::string& key) const {
  node_->known.insert(key);
  return static_cast<bool>(node_->yaml[key]);
}

bool Settings::isList(const std::string& key) const {
  return has(key) && node_->yaml[key].IsSequence();
}

InputError Settings::error(const std::string& key, const std::string& complaint) const {
  const YAML::Node value = node_->yaml[key];
  const std::string is = value ? " is " + oneLine(value) + ", but " : " is missing; ";
  return InputError(node_->origin + ": " + node_->field(key) + is + complaint);
}

double Settings::number(const std::string& key, const Range& range) const {
  if (!has(key)) throw error(key, "give a number, " + range.text());
  double value = 0;
  if (!YAML::convert<double>::decode(node_->yaml[key], value) || !range.contains(value)) {
    throw error(key, "must be a number, " + range.text());
  }
  return value;
}

double Settings::number(const std::string& key, const Range& range, double fallback) const {
  return has(key) ? number(key, range) : fallback;
}

std::int64_t Settings::integer(const std::string& key, const Range& range) const {
  if (!has(key)) throw error(key, "give a whole number, " + range.text());
  std::int64_t value = 0;
  if (!YAML::convert<std::int64_t>::decode(node_->yaml[key], value) ||
      !range.contains(static_cast<double>(value))) {
    throw error(key, "must be a whole number, " + range.text());
  }
  return value;
}

std::int64_t Settings::integer(const std::string& key, const Range& range, std::int64_t fallback) const {
  return has(key) ? integer(key, range) : fallback;
}

bool Settings::flag(const std::string& key, bool fallback) const {
  if (!has(key)) return fallback;
  bool value = false;
  if (!YAML::convert<bool>::decode(node_->yaml[key], value)) throw error(key, "must be true or false");
  return value;
}

std::string Settings::text(const std::string& key) const {
  if (!has(key)) throw error(key, "give a text");
  if (!node_->yaml[key].IsScalar()) throw error(key, "must be a text");
  return node_->yaml[key].Scalar();
}

std::vector<std::string> Settings::texts(const std::string& key) const {
  if (!has(key) || !node_->yaml[key].IsSequence()) throw error(key, "must be a list of texts");
  std::vector<std::string> texts;
  for (const YAML::Node& entry : node_->yaml[key]) {
    if (!entry.IsScalar()) throw error(key, "must be a list of texts");
    texts.push_back(entry.Scalar());
  }
  return texts;
}

std::string Settings::text(const std::string& key, const std::string& fallback) const {
  return has(key) ? text(key) : fallback;
}

std::string Settings::choice(const std::string& key, const std::vector<std::string>& choices) const {
  if (!has(key)) throw error(key, "give one of " + joined(choices));
  const YAML::Node value = node_->yaml[key];
  if (!value.IsScalar() || std::find(choices.begin(), choices.end(), value.Scalar()) == choices.end()) {
    throw error(key, "must be one of " + joined(choices));
  }
  return value.Scalar();
}

std::string Settings::choice(const std::string& key, const std::vector<std::string>& choices,
                             const std::string& fallback) const {
  return has(key) ? choice(key, choices) : fallback;
}

std::vector<double> Settings::numbers(const std::string& key, const Range& range) const {
  if (!has(key)) throw error(key, "give a list of numbers, each " + range.text());
  const YAML::Node list = node_->yaml[key];
  if (!list.IsSequence()) throw error(key, "must be a list of numbers, each " + range.text());
  std::vector<double> values;
  values.reserve(list.size());
  for (const auto& entry : list) {
    double value = 0;
    if (!YAML::convert<double>::decode(entry, value) || !range.contains(value)) {
      throw InputError(node_->origin + ": " + node_->field(key) + "[" + std::to_string(values.size()) +
                       "] is " + oneLine(entry) + ", but must be a number, " + range.text());
    }
    values.push_back(value);
  }
  return values;
}

std::vector<std::vector<std::string>> Settings::lists(const std::string& key) const {
  try {
    if (has(key)) return node_->yaml[key].as<std::vector<std::vector<std::string>>>();
  } catch (const YAML::Exception&) {  // it is something else
  }
  throw error(key, "must be a list of lists");
}

double Settings::numberOrNull(const std::string& key, const Range& range) const {
  return has(key) && node_->yaml[key].IsNull() ? NAN : number(key, range);
}

Settings Settings::section(const std::string& key) const {
  if (!has(key)) throw error(key, "give a mapping");
  if (!node_->yaml[key].IsMap()) throw error(key, "must be a mapping");
  auto opened = std::make_shared<Node>(Node{node_->yaml[key], node_->origin, node_->field(key), {}, {}});
  node_->opened.push_back(opened);
  return Settings(opened);
}

std::vector<Settings> Settings::sections(const std::string& key) const {
  if (!has(key)) throw error(key, "give a list of mappings");
  const YAML::Node list = node_->yaml[key];
  if (!list.IsSequence()) throw error(key, "must be a list of mappings");
  std::vector<Settings> result;
  for (const auto& entry : list) {
    const std::string field = node_->field(key) + "[" + std::to_string(result.size()) + "]";
    if (!entry.IsMap()) {
      throw InputError(node_->origin + ": " + field + " is " + oneLine(entry) + ", but must be a mapping");
    }
    auto opened = std::make_shared<Node>(Node{entry, node_->origin, field, {}, {}});
    node_->opened.push_back(opened);
    result.push_back(Settings(opened));
  }
  return result;
}

std::vector<std::string> Settings::keys() const {
  std::vector<std::string> result;
  for (const auto& entry : node_->yaml) result.push_back(entry.first.Scalar());
  return result;
}

void Settings::refuseUnknown() const {
  for (const std::string& key : keys()) {
    if (node_->known.count(key) == 0) {
      const std::vector<std::string> known(node_->known.begin(), node_->known.end());
      throw InputError(node_->origin + ": " + node_->field(key) +
                       " is not a known setting; known here: " + joined(known));
    }
  }
  for (const auto& opened : node_->opened) Settings(opened).refuseUnknown();
}

const std::string& Settings::origin() const {
  return node_->origin;
}

}  // namespace fsr::settings
