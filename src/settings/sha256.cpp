#include "fsr_pressure_map/settings/sha256.h"

#include <openssl/evp.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <vector>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr {

namespace {

class Digest {
 public:
  Digest() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
    require(EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr));
  }
  void add(const void* bytes, std::size_t size) { require(EVP_DigestUpdate(context_.get(), bytes, size)); }
  std::string hexadecimal() {
    std::array<unsigned char, 32> digest{};
    require(EVP_DigestFinal_ex(context_.get(), digest.data(), nullptr));
    constexpr char kDigits[] = "0123456789abcdef";
    std::string text;
    for (const unsigned char byte : digest) {
      text += kDigits[byte >> 4];
      text += kDigits[byte & 15];
    }
    return text;
  }

 private:
  static void require(int done) {
    if (done != 1) throw std::runtime_error("the crypto library does not offer SHA-256");
  }
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

}  // namespace

std::string sha256(const void* bytes, std::size_t size) {
  Digest digest;
  digest.add(bytes, size);
  return digest.hexadecimal();
}

std::string sha256OfFile(const std::string& path) {
  const std::unique_ptr<std::FILE, decltype(&std::fclose)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  Digest digest;
  std::vector<char> chunk(1 << 20);
  while (file) {
    const std::size_t size = std::fread(chunk.data(), 1, chunk.size(), file.get());
    if (size == 0) break;
    digest.add(chunk.data(), size);
  }
  if (!file || std::ferror(file.get()))
    throw InputError(path + ": cannot be read (" + std::strerror(errno) + ")");
  return digest.hexadecimal();
}

}  // namespace fsr
