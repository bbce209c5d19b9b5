#include "settings/sha256.h"

#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>
#include <vector>

#include "settings/regular_file.h"

namespace fsr::settings {

namespace {

void require(int done) {
  if (done != 1) throw std::runtime_error("the crypto library does not offer SHA-256");
}

}  // namespace

struct Sha256::Context {
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> digest{EVP_MD_CTX_new(), EVP_MD_CTX_free};
};

Sha256::Sha256() : context_(std::make_unique<Context>()) {
  require(EVP_DigestInit_ex(context_->digest.get(), EVP_sha256(), nullptr));
}

Sha256::~Sha256() = default;
Sha256::Sha256(Sha256&&) noexcept = default;

void Sha256::add(const void* bytes, std::size_t size) {
  require(EVP_DigestUpdate(context_->digest.get(), bytes, size));
}

std::string Sha256::hexadecimal() {
  std::array<unsigned char, 32> digest{};
  require(EVP_DigestFinal_ex(context_->digest.get(), digest.data(), nullptr));
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : digest) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

std::string sha256(const void* bytes, std::size_t size) {
  Sha256 digest;
  digest.add(bytes, size);
  return digest.hexadecimal();
}

std::string sha256OfFile(const std::string& path, std::size_t skip) {
  RegularFile file(path);
  Sha256 digest;
  std::vector<char> chunk(1 << 20);
  for (std::size_t left = skip; left > 0;) {
    const std::size_t size = file.read(chunk.data(), std::min(left, chunk.size()));
    if (size == 0) break;
    left -= size;
  }
  while (const std::size_t size = file.read(chunk.data(), chunk.size())) digest.add(chunk.data(), size);
  return digest.hexadecimal();
}

}  // namespace fsr::settings
