#pragma once
// The files of the page, as they are on the disk.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace haptic::gateway {

/// The file that `path` (a Target's) means below `folder`; nothing if there is none, or if a link leads out
/// of the folder.
std::optional<std::filesystem::path> find_file(const std::filesystem::path& folder, std::string_view path);

/// By the name's ending.
std::string_view content_type(std::string_view name);

/// How long a browser may keep the file: those below /assets have their content's hash in their name.
std::string_view cache_control(std::string_view path);

}  // namespace haptic::gateway
