// Writes the bags of a blind case and the sealed key.

#include <filesystem>
#include <iostream>
#include <sstream>

#include "blind/blind_case.h"
#include "blind/case_bags.h"
#include "blind/case_files.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "ros/bags/bag_writer.h"
#include "settings/command_line.h"
#include "settings/replace_file.h"

namespace {

fsr::settings::CommandLine commandLine() {
  fsr::settings::CommandLine line(
      "blind_case", "--name NAME --output CASE [--effect ID[:FORM],...]",
      "Bags of a simulated rig with something hidden in it, by formulas that the package does "
      "not know.");
  line.option("name", "NAME", "of the case: rig, protocol, sheet, noise and room are drawn from its hash")
      .option("output", "CASE", "writes CASE/bags/*.bag and CASE/key.yaml")
      .option("effect", "ID[:FORM],...",
              "what to hide; without a form one of set A is drawn; none = nothing hidden")
      .option("snr", "S", "rms left by each effect after the static fit, by the rms of all noise (1)")
      .option("kpa", "K", "instead of --snr: error at the map that each effect causes [kPa]")
      .option("class", "NAME", "class of the protocol; drawn where it is not given")
      .option("size", "full|small", "at most 3,000,000 or 600,000 readings (small)")
      .option("seed", "N", "without --name: seed of a case with a fixed protocol (1)")
      .option("protocol", "NAME", "without --name: what the chamber does (two_speeds)")
      .option("key", "FILE", "without --name: file of the key; the bags then go to --output itself")
      .option("follow", "KEY",
              "the campaign of this key goes on, under --protocol: same sheet, effects, strength, noise")
      .flag("no-thermometer", "record no temperature")
      .flag("everywhere", "confine no effect to some taxels or surfaces")
      .flag("list", "print the effects, their forms and the set of each, ID:FORM:SET")
      .flag("classes", "print the classes of protocols");
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

blind::CaseSpec namedSpecFrom(const fsr::settings::CommandLine& line) {
  for (const char* other : {"seed", "protocol", "key", "follow"}) {
    if (line.has(other)) {
      throw fsr::settings::InputError(std::string("--") + other +
                                      " is for cases without a name; leave out one of the two");
    }
  }
  blind::CaseSpec spec;
  spec.name = line.requiredText("name");
  spec.protocol_class = line.text("class", "");
  const std::string size = line.text("size", "small");
  if (size != "full" && size != "small") {
    throw fsr::settings::InputError("--size is \"" + size + "\", but must be full or small");
  }
  spec.most_readings = size == "small" ? blind::kSmallReadings : blind::kFullReadings;
  if (line.has("kpa")) {
    if (line.has("snr"))
      throw fsr::settings::InputError("--snr and --kpa both set the size; give one of them");
    spec.kpa = line.number("kpa", 1, {1e-3, 1e4, "kPa"});
  }
  spec.snr = line.number("snr", 1, {0, 100, ""});
  spec.local = !line.has("everywhere");
  const std::string effects = line.text("effect", "none");
  if (effects != "none") spec.effects = effectsIn(effects);
  return spec;
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
  for (const blind::HiddenForm& form : blind::hiddenForms()) {
    std::cout << form.id << ":" << form.form << ":" << form.set << "\n";
  }
}

void write(const blind::BlindCase& made, const std::string& output, const std::string& key_file) {
  std::filesystem::create_directories(output);
  fsr::settings::replaceFile(key_file, blind::keyText(made));
  fsr_ros::BagOptions options;
  options.ambient_pressure = blind::kAmbientPressure;
  options.session.session_id = "blind";
  options.session.use = "chamber";
  options.session.mounted_on = "fixture";
  options.session.protocol = made.spec.then.empty() ? made.spec.protocol : made.spec.then;
  for (const fsr::dataset::Recording& recording : made.recordings) {
    fsr_ros::writeBag(output + "/" + recording.name, recording, options);
  }
}

}  // namespace

int main(int argc, char** argv) {
  return fsr::settings::runTool("blind_case", [&] {
    fsr::settings::CommandLine line = commandLine();
    if (!line.parse(argc, argv, std::cout)) return 0;
    if (line.has("list")) {
      list();
      return 0;
    }
    if (line.has("classes")) {
      for (const std::string& name : blind::protocolClasses()) std::cout << name << "\n";
      return 0;
    }
    if (line.has("name")) {
      blind::writeCase(blind::makeCase(namedSpecFrom(line)), line.requiredText("output"));
      return 0;
    }
    const std::string output = line.requiredText("output"), key = line.requiredText("key");
    write(blind::makeCase(specFrom(line)), output, key);
    return 0;
  });
}
