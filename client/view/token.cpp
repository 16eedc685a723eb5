#include "client/view/token.h"

#include <openssl/crypto.h>
#include <openssl/sha.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>

namespace haptic::gateway {
namespace {

constexpr std::size_t kShortest = 16;
constexpr std::size_t kLongest = 256;

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         std::string_view("-._~").find(c) != std::string_view::npos;
}

std::array<unsigned char, SHA256_DIGEST_LENGTH> digest_of(std::string_view text) {
  std::array<unsigned char, SHA256_DIGEST_LENGTH> digest{};
  ::SHA256(reinterpret_cast<const unsigned char*>(text.data()), text.size(), digest.data());
  return digest;
}

}  // namespace

std::string Token::problem(std::string_view text) {
  if (text.size() < kShortest || text.size() > kLongest) {
    return "a token has 16 to 256 characters";
  }
  if (!std::all_of(text.begin(), text.end(), is_plain)) {
    return "a token has no characters but A-Z a-z 0-9 - . _ ~";
  }
  return {};
}

Token Token::from_file(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) {
    throw std::runtime_error(file + ": cannot be read: " + std::strerror(errno));
  }
  std::string text(kLongest + 2, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (in.bad()) {
    throw std::runtime_error(file + ": cannot be read");
  }
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.ends_with('\n')) {
    text.pop_back();
  }
  if (text.ends_with('\r')) {
    text.pop_back();
  }
  if (const std::string wrong = problem(text); !wrong.empty()) {
    throw std::runtime_error(file + ": " + wrong);
  }
  return Token(text);
}

Token::Token(std::string_view text) : digest_(digest_of(text)) {}

bool Token::is(std::string_view text) const {
  const auto other = digest_of(text);
  return CRYPTO_memcmp(digest_.data(), other.data(), digest_.size()) == 0;
}

}  // namespace haptic::gateway
