// Writes the bags of a blind case, a file with what a user would know about them, and the sealed key.

#include <filesystem>
#include <iostream>
#include <sstream>

#include "blind/blind_case.h"
#include "blind/case_files.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "ros/bags/bag_writer.h"
#include "settings/command_line.h"
#include "settings/replace_file.h"
#include "settings/sha256.h"

namespace {

fsr::settings::CommandLine commandLine() {
  fsr::settings::CommandLine line(
      "blind_case", "--output DIR --key FILE [--effect ID[:FORM]]...",
      "Bags of a simulated rig with something hidden in it, by formulas that the package does "
      "not know.");
  line.option("output", "DIR", "folder for the bags and case.yaml")
      .option("key", "FILE", "the sealed key; keep it apart from the bags")
      .option("seed", "N", "of the case (1)")
      .option("effect", "ID[:FORM],...",
              "what to hide; without a form the seed draws one; none = nothing hidden")
      .option("snr", "S", "rms left by each effect after the static fit, by the rms of all noise (1)")
      .option("protocol", "NAME", "what the chamber does (two_speeds)")
      .option("size", "full|small", "7 x 10 taxels and six surfaces, or 3 x 4 and three (full)")
      .option("follow", "KEY",
              "the campaign of this key goes on, under --protocol: same sheet, effects, strength, noise")
      .flag("no-thermometer", "record no temperature")
      .flag("everywhere", "confine no effect to some taxels or surfaces")
      .flag("list", "print the effects and their forms");
  return line;
}

std::vector<blind::EffectSpec> effectsIn(const std::string& text) {
  std::vector<blind::EffectSpec> effects;
  std::istringstream list(text);
  for (std::string item; std::getline(list, item, ',');) {
    const std::size_t colon = item.find(':');
    const std::string form = colon == std::string::npos ? "" : item.substr(colon + 1);
    effects.push_back({item.substr(0, colon), form, {}});
  }
  return effects;
}

blind::CaseSpec specFrom(const fsr::settings::CommandLine& line) {
  blind::CaseSpec spec;
  if (line.has("follow")) {
    spec = blind::specFromKey(line.text("follow", ""));
    spec.then = line.text("protocol", spec.protocol);
    return spec;
  }
  const std::string size = line.text("size", "full");
  if (size != "full" && size != "small") {
    throw fsr::settings::InputError("--size is \"" + size + "\", but must be full or small");
  }
  if (size == "small") blind::makeSmall(spec);
  spec.seed = static_cast<std::uint64_t>(line.integer("seed", 1, {0, 1e15, ""}));
  spec.snr = line.number("snr", 1, {0, 100, ""});
  spec.protocol = line.text("protocol", spec.protocol);
  spec.thermometer = !line.has("no-thermometer");
  spec.local = !line.has("everywhere");
  const std::string effects = line.text("effect", "none");
  if (effects != "none") spec.effects = effectsIn(effects);
  return spec;
}

void list() {
  for (const blind::HiddenForm& form : blind::hiddenForms()) std::cout << form.id << ":" << form.form << "\n";
}

void write(const blind::BlindCase& made, const std::string& output, const std::string& key_file) {
  std::filesystem::create_directories(output);
  const std::string key = blind::keyText(made);
  fsr::settings::replaceFile(key_file, key);
  fsr_ros::BagOptions options;
  options.ambient_pressure = blind::kAmbientPressure;
  options.session.session_id = "blind";
  options.session.use = "chamber";
  options.session.mounted_on = "fixture";
  options.session.protocol = made.spec.then.empty() ? made.spec.protocol : made.spec.then;
  for (const fsr::dataset::Recording& recording : made.recordings) {
    fsr_ros::writeBag(output + "/" + recording.name, recording, options);
  }
  const std::string hash = fsr::settings::sha256(key.data(), key.size());
  fsr::settings::replaceFile(output + "/case.yaml", blind::publicText(made, hash));
}

}  // namespace

int main(int argc, char** argv) {
  return fsr::settings::runTool("blind_case", [&] {
    fsr::settings::CommandLine line = commandLine();
    if (!line.parse(argc, argv)) {
      std::cout << line.help();
      return 0;
    }
    if (line.has("list")) {
      list();
      return 0;
    }
    const std::string output = line.requiredText("output"), key = line.requiredText("key");
    write(blind::makeCase(specFrom(line)), output, key);
    return 0;
  });
}
