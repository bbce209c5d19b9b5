#include "settings/foreign_error.h"

#include <algorithm>
#include <filesystem>
#include <new>
#include <stdexcept>

namespace fsr::settings {

namespace {

std::string oneLine(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text.substr(0, text.find_last_not_of(" .") + 1);
}

}  // namespace

InputError sentenceOf(const std::exception& error) {
  if (const auto* const ours = dynamic_cast<const InputError*>(&error)) return *ours;
  if (const auto* const file = dynamic_cast<const std::filesystem::filesystem_error*>(&error)) {
    return InputError(file->path1().string() + ": cannot be used (" + file->code().message() +
                      "); give the path of a file that exists and may be read");
  }
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr ||
      dynamic_cast<const std::length_error*>(&error) != nullptr) {
    return InputError("this input needs more memory than the system gives; use a part of it");
  }
  return InputError("this input cannot be used (" + oneLine(error.what()) + ")");
}

InputError sentenceAbout(const std::string& path, const std::exception& error) {
  const std::string sentence = sentenceOf(error).what();
  return InputError(sentence.rfind(path + ": ", 0) == 0 ? sentence : path + ": " + sentence);
}

}  // namespace fsr::settings
