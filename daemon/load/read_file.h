#pragma once
// Files into memory, bounded, from regular files only. Not real-time safe.

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace haptic::load {

/// The largest config, scene or path that is read.
inline constexpr std::size_t kMaxTextBytes = 64U << 20U;
/// The largest mesh file that is read: about thirty million cells.
inline constexpr std::size_t kMaxMeshBytes = std::size_t{1} << 30U;

/// The whole file. Throws LoadError if it is missing, not to be read, not a regular file (a pipe is never
/// waited for) or larger than `max_bytes`, which is checked before anything is read.
std::string read_file(const std::filesystem::path& path, std::size_t max_bytes);

/// `path` as the file that names it means it: relative to the folder of `file`.
std::filesystem::path relative_to(const std::filesystem::path& file, const std::string& path);

/// The text in quotes for a message: what does not print is escaped, and a long one is cut.
std::string in_quotes(std::string_view text);

}  // namespace haptic::load
