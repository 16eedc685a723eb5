#pragma once
// Reads a scene file only as far as its text goes; the daemon judges what it says.

#include <string>

#include "haptic/v1/scene.pb.h"

namespace haptic::cli {

/// Text format, or JSON where the name ends in ".json". Throws client::NotFound or client::Invalid with the
/// place of the first mistake.
v1::Scene read_scene_text(const std::string& path);

}  // namespace haptic::cli
