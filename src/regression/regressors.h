#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fsr_pressure_map/regression/regressor_options.h"
#include "regression/code_statistics.h"
#include "regression/grnn/kernel_mean.h"
#include "regression/regressor.h"

namespace fsr::regression {

// The names of the regressors' options in files, parameters and command lines. Every ...FromName() throws
// InputError that lists the names.

/// "sigma", "matlab".
std::vector<std::string> spreadNames();
std::string spreadName(SpreadMeaning spread);
SpreadMeaning spreadFromName(const std::string& name);

/// "squared", "literal".
std::vector<std::string> distanceNames();
std::string distanceName(KernelDistance distance);
KernelDistance distanceFromName(const std::string& name);

/// "each_sample", "equal_bins".
std::string weightingName(SampleWeighting weighting);
SampleWeighting weightingFromName(const std::string& name);

/// "draws", "distinct".
std::vector<std::string> leafRuleNames();
std::string leafRuleName(LeafCount count);
LeafCount leafRuleFromName(const std::string& name);

/// A bandwidth, or none for "auto". Throws InputError if `text` is neither.
std::optional<double> bandwidthFromText(const std::string& text);

// The table of regressors: everything that the other rooms need to know about a regressor. A new regressor
// is one file with its class and its RegressorEntry, and a line in regressors.cpp.

/// Where the options of a regressor are written, e.g. attributes of a calibration file.
class OptionWriter {
 public:
  virtual ~OptionWriter() = default;
  virtual void text(const std::string& name, const std::string& value) = 0;
  virtual void integer(const std::string& name, std::uint64_t value) = 0;
  virtual void number(const std::string& name, double value) = 0;
};

/// Where they are read. All throw InputError if there is no such option of this type.
class OptionReader {
 public:
  virtual ~OptionReader() = default;
  virtual std::string text(const std::string& name) const = 0;
  virtual std::uint64_t integer(const std::string& name) const = 0;
  virtual double number(const std::string& name) const = 0;
};

/// How the answer changes between two trained values of the second input.
enum class BetweenInputs {
  kSteps,     ///< constant, with a step in between (forest)
  kStraight,  ///< linear in the input (linear regression)
  kKernel,    ///< a mean of the classes, weighted by a Gaussian of the distance (GRNN)
};

/// How a regressor uses a second input beside the reading.
struct SecondInput {
  /// Answers at the inputs of each class [classes]. At least one class has readings, and the scales of
  /// `inputs` belong to these readings.
  std::vector<Fit> (*fit)(const ClassReadings& readings, const ClassInputs& inputs,
                          const RegressorOptions& options) = nullptr;
  BetweenInputs between = BetweenInputs::kSteps;
  /// Whether the second input may have several columns (one-hot).
  bool several_columns = false;
  /// Whether a model with these options takes a second input; null = always. `condition` completes the
  /// sentence "grnn does so only with ...".
  bool (*permitted)(const RegressorOptions& options) = nullptr;
  const char* condition = "";
  /// kKernel: sigma of the kernel in standardised units.
  double (*sigma)(const RegressorOptions& options) = nullptr;
  /// kKernel: kernel mean of each class, with all logarithms of the weight. Every class has a reading.
  std::vector<KernelMean> (*kernels)(const ClassReadings& readings,
                                     const RegressorOptions& options) = nullptr;
};

/// One regressor. Whether it is mergeable depends on its options: see Regressor::mergeable().
struct RegressorEntry {
  const char* name = "";     ///< as in files and options, e.g. "grnn"
  const char* summary = "";  ///< what it is, a few words
  /// Throws InputError if the options are not permitted.
  std::unique_ptr<Regressor> (*make)(const RegressorOptions& options) = nullptr;
  /// Options in the calibration file; null = none.
  void (*write)(const RegressorOptions& options, OptionWriter& writer) = nullptr;
  void (*read)(const OptionReader& reader, RegressorOptions& options) = nullptr;
  /// Whether files of other models contain its options too. True for GRNN and forest only, whose options
  /// have been in every file since schema 1.
  bool in_every_file = false;
  std::optional<SecondInput> second_input = {};  ///< empty = takes the reading only
};

struct RegressorTable {
  std::vector<RegressorEntry> entries;

  /// Null if there is none of that name.
  const RegressorEntry* find(const std::string& name) const;
};

/// The regressors of this package: linear, grnn, forest, monotone.
const RegressorTable& packageRegressors();

/// The table in which the options' name is looked up.
const RegressorTable& tableOf(const RegressorOptions& options);

/// The entry of the named regressor. Throws InputError that lists the names.
const RegressorEntry& entryOf(const RegressorOptions& options);

/// "linear", "grnn", "forest", "monotone".
std::vector<std::string> regressorNames();

/// Throws InputError that lists the names, or that says which option of the named regressor is not permitted.
std::unique_ptr<Regressor> makeRegressor(const RegressorOptions& options);

}  // namespace fsr::regression
