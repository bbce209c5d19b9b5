#include "study/evaluation.h"

#include <gtest/gtest.h>

#include "matrix/for_each_taxel.h"

namespace fsr::study {
namespace {

constexpr std::size_t kTaxels = 3;

float errorOf(std::size_t taxel, std::size_t place) {
  return static_cast<float>(1000000 * taxel + place) - 5;
}

void expectRowsAsWritten(std::size_t length) {
  ErrorRows rows(kTaxels, length);
  matrix::forEachTaxel(kTaxels, 2, [&](std::size_t taxel) {
    ErrorRows::Writer writer(rows, taxel);
    for (std::size_t i = 0; i < length; ++i) writer.add(errorOf(taxel, i));
    writer.finish();
  });
  std::size_t wrong = 0;
  for (std::size_t taxel = 0; taxel < kTaxels; ++taxel) {
    ErrorRows::Reader reader(rows, taxel);
    for (std::size_t i = 0; i < length; ++i) wrong += reader.next() != errorOf(taxel, i);
  }
  EXPECT_EQ(wrong, 0u) << length;
}

TEST(ErrorRows, AreReadAsTheyWereWritten) {
  for (const std::size_t length : {0u, 1u, 4095u, 4096u, 4097u, 20000u}) expectRowsAsWritten(length);
}

TEST(ErrorRows, OfALongRecordingAreReadAsTheyWereWritten) {
  expectRowsAsWritten(1000001);  // 12 MB, in a file
}

}  // namespace
}  // namespace fsr::study
