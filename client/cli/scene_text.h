#pragma once
// Scene files, only as far as their text goes; the daemon judges what they say.

#include <string>

#include "haptic/v1/scene.pb.h"

namespace haptic::cli {

/// Reads text format. What is wrong with it is returned, as "LINE:COLUMN: reason"; empty: nothing.
std::string parse_text(const std::string& text, google::protobuf::Message& message);

/// Text format, or JSON where the name ends in ".json". Throws client::NotFound or client::Invalid with the
/// place of the first mistake.
v1::Scene read_scene_text(const std::string& path);

/// The same way round. The file is there whole or not at all; one that is there already stays unless `force`.
/// Throws client::Error.
void write_scene_text(const v1::Scene& scene, const std::string& path, bool force);

}  // namespace haptic::cli
