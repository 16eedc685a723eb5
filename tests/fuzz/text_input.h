#pragma once
// What the targets that read config and scene files share.

#include <cstdint>
#include <string>

#include "load/text_message.h"

namespace haptic::fuzz {

inline std::string text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// A text that starts with { is read as JSON: no text format does.
inline load::Syntax syntax_of(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string::npos && text[first] == '{' ? load::Syntax::kJson : load::Syntax::kText;
}

}  // namespace haptic::fuzz
