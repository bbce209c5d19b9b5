#pragma once

#include <string>
#include <string_view>

namespace fsr::settings {

/// What a file is, as its first bytes tell: "a bag", "a calibration", "a JSON file". A YAML file is told by
/// its first key, or by `format`: "a YAML file of the kind plan", "a fsr_pressure_map tare". Empty where
/// there is no byte.
std::string kindOf(std::string_view beginning);

/// The same of a file. Empty where there is none, or nothing in it.
std::string kindOfFile(const std::string& path);

/// Kinds that tools write. What is written later can be checked against them before a long computation.
namespace file_kind {
constexpr char kBag[] = "a bag";
constexpr char kCalibration[] = "a calibration";
constexpr char kJson[] = "a JSON file";
constexpr char kTable[] = "a table of values";
constexpr char kPage[] = "a web page";
constexpr char kPicture[] = "a picture";
constexpr char kCompressed[] = "a compressed file";
}  // namespace file_kind

}  // namespace fsr::settings
