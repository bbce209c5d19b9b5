#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "hdf5/file.h"

namespace fsr::hdf5 {

/// The names of an enumeration in a file.
template <typename Value>
using Names = std::vector<std::pair<Value, std::string>>;

/// One list of members for both directions: every call writes a member to a file, or reads it from there. A
/// new member of a struct is one line. Reading throws InputError that names what is missing or does not fit.
///
///     if (!file.group("/session", zero.expected())) return;
///     file.attribute("rmse", zero.rmse);
///     file.within("rmse", {zero.rmse}, 0, 1e9);
class Members {
 public:
  explicit Members(Writer& writer) : writer_(&writer) {}
  explicit Members(const Reader& reader) : reader_(&reader) {}

  bool reads() const { return reader_ != nullptr; }
  Writer& writer() { return *writer_; }
  const Reader& reader() const { return *reader_; }
  std::string path(const std::string& name) const { return group_ + "/" + name; }
  bool has(const std::string& name) const { return reader_->has(path(name)); }

  /// The calls that follow are about this group. `present`: whether to write it. Returns whether it is there.
  bool group(const std::string& path, bool present = true);
  /// An attribute of the group for people: it is not read.
  void note(const std::string& name, const std::string& text);

  // Attributes of the group.
  void attribute(const std::string& name, std::string& text);
  void attribute(const std::string& name, double& value);
  void attribute(const std::string& name, std::uint64_t& value);
  void attribute(const std::string& name, bool& value);
  template <typename Value>
  void attribute(const std::string& name, Value& value, const Names<Value>& names) {
    std::string text = reads() ? "" : nameOf(value, names);
    attribute(name, text);
    if (reads()) value = named(name, text, names);
  }
  /// Several numbers in one attribute; `values` is made by std::tie.
  template <typename... Number>
  void numbers(const std::string& name, std::tuple<Number&...> values) {
    std::vector<double> list = std::apply([](auto&... one) { return std::vector<double>{one...}; }, values);
    numberList(name, list);
    std::size_t at = 0;
    std::apply([&](auto&... one) { ((one = list[at++]), ...); }, values);
  }

  // Datasets below the group.
  template <typename T>
  void dataset(const std::string& name, std::vector<T>& values, const Shape& shape, const std::string& unit,
               const std::string& meaning) {
    if (reads()) {
      values = reader_->dataset<T>(path(name), shape);
    } else {
      writer_->dataset(path(name), values, shape, unit, meaning);
    }
  }
  /// One of any length, which the file has only where it is not empty.
  template <typename T>
  void column(const std::string& name, std::vector<T>& values, const std::string& unit,
              const std::string& meaning) {
    if (reads() ? has(name) : !values.empty())
      dataset(name, values, reads() ? reader_->shape(path(name)) : Shape{values.size()}, unit, meaning);
  }
  void texts(const std::string& name, std::vector<std::string>& texts, const std::string& meaning);

  // Datasets of a list of structs, one for each member.
  /// `member` of each element, a text. Reading makes an empty list as long as the texts.
  template <typename Element, typename Member>
  void texts(const std::string& name, std::vector<Element>& list, Member member, const std::string& meaning) {
    std::vector<std::string> all;
    for (Element& one : list) all.push_back(std::invoke(member, one));
    texts(name, all, meaning);
    if (list.empty()) list.resize(all.size());
    requireLength(name, all.size(), list.size());
    for (std::size_t i = 0; i < list.size(); ++i) std::invoke(member, list[i]) = all[i];
  }
  /// The same of an enumeration.
  template <typename Element, typename Value>
  void texts(const std::string& name, std::vector<Element>& list, Value Element::*member,
             const Names<Value>& names, const std::string& meaning) {
    std::vector<std::string> all;
    for (Element& one : list) all.push_back(reads() ? "" : nameOf(one.*member, names));
    texts(name, all, meaning);
    requireLength(name, all.size(), list.size());
    if (!reads()) return;
    for (std::size_t i = 0; i < list.size(); ++i) list[i].*member = named(name, all[i], names);
  }
  /// The numbers of each element, stored as `Stored`. `numbers` is a member, a number or an array of them, or
  /// a function that returns a std::tie.
  template <typename Stored, typename List, typename Numbers>
  void rows(const std::string& name, List& list, Numbers numbers, const Shape& shape, const std::string& unit,
            const std::string& meaning) {
    std::vector<Stored> values;
    if (reads()) values = reader_->dataset<Stored>(path(name), shape);
    std::size_t at = 0;
    const auto transfer = [&](auto& number) {
      if (reads()) {
        number = static_cast<std::decay_t<decltype(number)>>(values.at(at++));
      } else {
        values.push_back(static_cast<Stored>(number));
      }
    };
    const auto each = [&](auto&& member) {
      if constexpr (std::is_arithmetic_v<std::decay_t<decltype(member)>>) {
        transfer(member);
      } else {
        std::apply([&](auto&... number) { (transfer(number), ...); }, member);
      }
    };
    for (auto& one : list) each(std::invoke(numbers, one));
    if (!reads()) writer_->dataset(path(name), values, shape, unit, meaning);
  }

  /// Refuses values that were read and are not from `low` to `high`. NaN is refused.
  void within(const std::string& name, const std::vector<double>& values, double low, double high) const;
  /// Refuses what was read and does not fit: "its /group/name WHAT".
  void require(bool fits, const std::string& name, const std::string& what) const {
    if (reads() && !fits) refuse(name, what);
  }
  [[noreturn]] void refuse(const std::string& name, const std::string& what) const;

 private:
  void numberList(const std::string& name, std::vector<double>& values);
  void requireLength(const std::string& name, std::size_t found, std::size_t expected) const;
  template <typename Value>
  static std::string nameOf(Value value, const Names<Value>& names) {
    for (const auto& [known, name] : names) {
      if (known == value) return name;
    }
    return "";
  }
  template <typename Value>
  Value named(const std::string& member, const std::string& text, const Names<Value>& names) const {
    std::string all;
    for (const auto& [value, name] : names) {
      if (name == text) return value;
      all += (all.empty() ? "" : ", ") + name;
    }
    refuse(member, "is \"" + text + "\", but must be one of " + all);
  }

  Writer* writer_ = nullptr;
  const Reader* reader_ = nullptr;
  std::string group_;
};

}  // namespace fsr::hdf5
