#pragma once
// Secrets that a browser shows to be let in. Kept as digests and compared in constant time: how long a
// comparison takes tells nothing about them.

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace haptic::gateway {

class Token {
 public:
  /// What is wrong with a token, for a person; empty if nothing is. Right are 16 to 256 of the characters
  /// A-Z a-z 0-9 - . _ ~, which a URL carries as they are.
  static std::string problem(std::string_view text);

  /// Reads the first line of a file, which must be all that is in it. Throws std::runtime_error with the
  /// file's name and never with what is in it.
  static Token from_file(const std::string& file);

  explicit Token(std::string_view text);

  bool is(std::string_view text) const;

 private:
  std::array<unsigned char, 32> digest_;  // SHA-256
};

/// Who shows which token may do what. Without a token for observers anybody may observe.
struct Tokens {
  std::optional<Token> observe;
  std::optional<Token> drive;
};

}  // namespace haptic::gateway
