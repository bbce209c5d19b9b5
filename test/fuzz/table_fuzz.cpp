// A text table with any separator and decimal sign is read to its end, or refused with one sentence.
#include <cmath>

#include "dataset/table_reader.h"
#include "fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  if (size == 0) return 0;
  static constexpr char kSeparators[] = {0, ',', ';', '\t', ' '};
  fsr::dataset::TableFormat format;
  format.separator = kSeparators[bytes[0] % 5];
  format.header = static_cast<fsr::dataset::TableFormat::Header>(bytes[0] / 5 % 3);
  format.decimal_comma = bytes[0] >= 128;
  const fuzz::MemoryFile file(bytes + 1, size - 1);
  try {
    fsr::dataset::TableReader table(file.path(), format);
    while (table.next()) {
      for (std::size_t column = 0; column < table.columns(); ++column) {
        try {
          fuzz::require(std::isfinite(table.number(column)));
        } catch (const fsr::settings::InputError&) {
        }
      }
    }
  } catch (const fsr::settings::InputError&) {
  }
  return 0;
}
