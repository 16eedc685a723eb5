#pragma once
// What the outlines of meshes are, which a scene's description has as tetrahedra only. Pure.

#include <vector>

#include "haptic/v1/control.pb.h"
#include "proto/foxglove/scene_view.h"

namespace haptic::gateway {

/// The faces between what resists and what does not (materials without resistance, or nothing): of each
/// object in the order of the scene, empty where its shape has no embedded mesh or a wrong one. Object frame.
std::vector<view::Surface> surfaces_of(const v1::SceneDescription& scene);

}  // namespace haptic::gateway
