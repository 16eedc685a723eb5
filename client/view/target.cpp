#include "client/view/target.h"

#include <algorithm>

namespace haptic::gateway {
namespace {

constexpr std::string_view kTokenName = "token=";

int digit(char c) {
  if (c >= '0' && c <= '9') {
    return c - '0';
  }
  if (c >= 'a' && c <= 'f') {
    return c - 'a' + 10;
  }
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

// one part of a path, decoded
bool is_harmless(std::string_view part) {
  return !part.empty() && part.front() != '.' && std::all_of(part.begin(), part.end(), [](char c) {
    return static_cast<unsigned char>(c) >= ' ' && c != '\x7f' && c != '/' && c != '\\';
  });
}

std::optional<std::string> parse_path(std::string_view text) {
  if (!text.starts_with('/')) {
    return std::nullopt;
  }
  std::string path;
  while (text.size() > 1) {
    text.remove_prefix(1);
    const std::size_t end = std::min(text.find('/'), text.size());
    const std::optional<std::string> part = percent_decoded(text.substr(0, end));
    if (!part || !is_harmless(*part)) {
      return std::nullopt;
    }
    path += "/" + *part;
    text.remove_prefix(end);
  }
  return text == "/" ? path + "/index.html" : path;
}

}  // namespace

std::optional<std::string> percent_decoded(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      out += text[i];
      continue;
    }
    const int high = i + 2 < text.size() ? digit(text[i + 1]) : -1;
    const int low = i + 2 < text.size() ? digit(text[i + 2]) : -1;
    if (high < 0 || low < 0) {
      return std::nullopt;
    }
    out += static_cast<char>(16 * high + low);
    i += 2;
  }
  return out;
}

std::optional<Target> parse_target(std::string_view text) {
  const std::size_t question = std::min(text.find('?'), text.size());
  std::optional<std::string> path = parse_path(text.substr(0, question));
  if (!path) {
    return std::nullopt;
  }
  Target target{std::move(*path), std::nullopt};
  std::string_view query = text.substr(std::min(question + 1, text.size()));
  while (!query.empty()) {
    const std::size_t end = std::min(query.find('&'), query.size());
    const std::string_view item = query.substr(0, end);
    if (item.starts_with(kTokenName)) {
      if (target.token) {
        return std::nullopt;
      }
      target.token = percent_decoded(item.substr(kTokenName.size()));
      if (!target.token) {
        return std::nullopt;
      }
    }
    query.remove_prefix(std::min(end + 1, query.size()));
  }
  return target;
}

}  // namespace haptic::gateway
