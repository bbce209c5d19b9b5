#include <cmath>

#include "calibration/file/calibration_hdf5.h"
#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::calibration {

namespace {

const std::vector<std::pair<compensation::BlendRule, std::string>> kBlends = {
    {compensation::BlendRule::kNearest, "nearest"},
    {compensation::BlendRule::kKernel, "kernel"},
    {compensation::BlendRule::kInterpolate, "interpolate"},
    {compensation::BlendRule::kByName, "by_name"}};

std::string blendName(compensation::BlendRule blend) {
  for (const auto& [known, name] : kBlends) {
    if (known == blend) return name;
  }
  return "";
}

compensation::BlendRule blendFromName(const std::string& name) {
  for (const auto& [blend, known] : kBlends) {
    if (known == name) return blend;
  }
  throw settings::InputError("its /rule blend is \"" + name +
                             "\", which this version does not know; update the package");
}

// A column of the rule; empty if the file has none.
std::vector<double> readColumn(const std::string& path, const hdf5::Reader& reader) {
  return reader.has(path) ? reader.dataset<double>(path, reader.shape(path)) : std::vector<double>{};
}

void requireSameLength(const std::vector<double>& a, const std::vector<double>& b, const std::string& group) {
  if (a.size() != b.size()) throw settings::InputError("its columns of " + group + " differ in length");
}

void requireAscending(const std::vector<double>& knots, const std::string& group) {
  for (std::size_t i = 0; i < knots.size(); ++i) {
    if (!std::isfinite(knots[i]) || (i > 0 && !(knots[i - 1] < knots[i]))) {
      throw settings::InputError("its knots of " + group + " do not ascend");
    }
  }
}

}  // namespace

void writeRule(const compensation::CurvatureTables& tables, hdf5::Writer& writer) {
  const compensation::CurvatureRule& rule = tables.rule;
  writer.group("/rule");
  writer.attribute("/rule", "blend", blendName(rule.blend));
  writer.attribute("/rule", "meaning", "how the tables of the classes become the table of any curvature");
  const auto column = [&](const std::string& path, const std::vector<double>& values, const std::string& unit,
                          const std::string& meaning) {
    if (!values.empty()) writer.dataset(path, values, {values.size()}, unit, meaning);
  };
  const std::vector<std::uint64_t> models(rule.model_of_class.begin(), rule.model_of_class.end());
  if (!models.empty()) {
    writer.dataset("/rule/model_of_class", models, {models.size()}, "",
                   "classes of one number share their tables; absent = each has its own");
  }
  column(
      "/rule/length_scale", rule.length_scale, "1/m",
      "distance in curvature at which a class's weight falls by exp(-1/2), one for all taxels or one each");
  column("/rule/law_curvature", rule.law.curvature, "1/m", "knots of the matrix's law of bending");
  column("/rule/law_gain", rule.law.gain, "", "pressure = gain x pressure without bending effects + offset");
  column("/rule/law_offset", rule.law.offset, "Pa", "likewise");
  column("/rule/unseen_pressure", rule.unseen.pressure, "Pa",
         "knots of the deviation of an unseen curvature");
  column("/rule/unseen_deviation", rule.unseen.deviation, "Pa",
         "midway between classes, beside the tables' own");
  if (rule.blend != compensation::BlendRule::kKernel) return;
  std::vector<float> log_weight;
  for (const regression::CodeTable& table : tables.tables) {
    log_weight.insert(log_weight.end(), table.log_weight.begin(), table.log_weight.end());
  }
  writer.dataset("/rule/log_weight", log_weight,
                 {tables.size.taxels(), tables.classes.size(), tables.full_scale + 1u}, "",
                 "[taxels x models x codes], logarithm of the kernel sum of each reading");
}

void readRule(const hdf5::Reader& reader, compensation::CurvatureTables& tables) {
  compensation::CurvatureRule& rule = tables.rule;
  rule.blend = blendFromName(reader.text("/rule", "blend"));
  rule.length_scale = readColumn("/rule/length_scale", reader);
  rule.law = {readColumn("/rule/law_curvature", reader), readColumn("/rule/law_gain", reader),
              readColumn("/rule/law_offset", reader)};
  rule.unseen = {readColumn("/rule/unseen_pressure", reader), readColumn("/rule/unseen_deviation", reader)};
  if (reader.has("/rule/model_of_class")) {
    const auto models = reader.dataset<std::uint64_t>("/rule/model_of_class", {tables.classes.size()});
    rule.model_of_class.assign(models.begin(), models.end());
  }
  requireAscending(rule.law.curvature, "/rule/law");
  requireAscending(rule.unseen.pressure, "/rule/unseen");
  requireSameLength(rule.law.curvature, rule.law.gain, "/rule/law");
  requireSameLength(rule.law.curvature, rule.law.offset, "/rule/law");
  requireSameLength(rule.unseen.pressure, rule.unseen.deviation, "/rule/unseen");
  if (rule.blend != compensation::BlendRule::kKernel) return;
  const std::size_t taxels = tables.size.taxels(), codes = tables.full_scale + 1u;
  if (rule.length_scale.size() != 1 && rule.length_scale.size() != taxels) {
    throw settings::InputError("its /rule/length_scale has neither one value nor one for each taxel");
  }
  const auto weights = reader.dataset<float>("/rule/log_weight", {taxels, tables.classes.size(), codes});
  for (std::size_t i = 0; i < tables.tables.size(); ++i) {
    const auto first = weights.begin() + static_cast<std::ptrdiff_t>(i * codes);
    tables.tables[i].log_weight.assign(first, first + static_cast<std::ptrdiff_t>(codes));
  }
}

}  // namespace fsr::calibration
