#include <png.h>

#include "fsr_pressure_map/settings/input_error.h"
#include "fsr_pressure_map/view/image.h"

namespace fsr::view {

std::string pngOf(const Image& image) {
  png_image header = {};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width());
  header.height = static_cast<png_uint_32>(image.height());
  header.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&header, bytes.data(), &size, 0, image.bytes().data(), 0, nullptr) == 0) {
    throw settings::InputError(std::string("the picture cannot be encoded as PNG: ") + header.message);
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace fsr::view
