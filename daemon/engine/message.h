#pragma once
// Text of errors, put together from words and numbers.

#include <array>
#include <charconv>
#include <concepts>
#include <string>
#include <string_view>

namespace haptic::engine {

inline void append_part(std::string& text, std::string_view words) { text += words; }

/// Whole numbers in full, others to six significant digits.
template <class Number>
requires std::integral<Number> || std::floating_point<Number>
void append_part(std::string& text, Number number) {
  std::array<char, 32> digits{};
  std::to_chars_result end{};
  if constexpr (std::floating_point<Number>) {
    end = std::to_chars(digits.data(), digits.data() + digits.size(), number, std::chars_format::general, 6);
  } else {
    end = std::to_chars(digits.data(), digits.data() + digits.size(), number);
  }
  text.append(digits.data(), end.ptr);
}

/// message("cell ", 7, " is flat") is "cell 7 is flat".
template <class... Parts>
std::string message(const Parts&... parts) {
  std::string text;
  (append_part(text, parts), ...);
  return text;
}

}  // namespace haptic::engine
