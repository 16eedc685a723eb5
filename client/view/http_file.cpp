#include "client/view/http_file.h"

#include <algorithm>
#include <array>
#include <utility>

namespace haptic::gateway {
namespace fs = std::filesystem;

std::optional<fs::path> find_file(const fs::path& folder, std::string_view path) {
  std::error_code error;
  const fs::path root = fs::canonical(folder, error);
  if (error || !path.starts_with('/')) {
    return std::nullopt;
  }
  const fs::path file = fs::canonical(root / path.substr(1), error);
  if (error || !fs::is_regular_file(file, error) || error) {
    return std::nullopt;
  }
  const auto [end_of_root, ignored] = std::mismatch(root.begin(), root.end(), file.begin(), file.end());
  return end_of_root == root.end() ? std::optional(file) : std::nullopt;
}

std::string_view content_type(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 16> kTypes = {{
      {".html", "text/html; charset=utf-8"},
      {".js", "text/javascript; charset=utf-8"},
      {".mjs", "text/javascript; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},
      {".json", "application/json"},
      {".map", "application/json"},
      {".webmanifest", "application/manifest+json"},
      {".txt", "text/plain; charset=utf-8"},
      {".md", "text/plain; charset=utf-8"},
      {".svg", "image/svg+xml"},
      {".png", "image/png"},
      {".jpg", "image/jpeg"},
      {".webp", "image/webp"},
      {".ico", "image/x-icon"},
      {".woff2", "font/woff2"},
      {".wasm", "application/wasm"},
  }};
  const auto* const found = std::find_if(kTypes.begin(), kTypes.end(),
                                         [&](const auto& entry) { return name.ends_with(entry.first); });
  return found == kTypes.end() ? "application/octet-stream" : found->second;
}

std::string_view cache_control(std::string_view path) {
  return path.starts_with("/assets/") ? "public, max-age=31536000, immutable" : "no-cache";
}

}  // namespace haptic::gateway
