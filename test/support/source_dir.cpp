#include "support/source_dir.h"

namespace test_support {

std::string sourceDir() {
  return FSR_SOURCE_DIR;  // a definition of this file only (test/CMakeLists.txt)
}

}  // namespace test_support
