#pragma once
// What viewers of Foxglove's kind can draw of a scene and its frames. Pure: messages in, messages out.
//
//     world --+-- object/NAME   where the object is; its shape is drawn in this frame, once
//             +-- device/NAME   where the device is
//
// HIPs and forces are drawn in the world frame. Metres, newtons, seconds; times are CLOCK_REALTIME in ns.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "foxglove/FrameTransforms.pb.h"
#include "foxglove/Log.pb.h"
#include "foxglove/SceneUpdate.pb.h"
#include "haptic/v1/control.pb.h"

namespace haptic::view {

inline constexpr double kArrowMetresPerNewton = 0.01;

/// Of more HIPs only those that are in contact are drawn, and no more than so many.
inline constexpr int kMostHips = 512;

/// What an object looks like, where its description does not tell: triangles in the object frame.
struct Surface {
  std::vector<double> points;          // x, y, z of each, m
  std::vector<std::uint32_t> indices;  // three for each triangle
};

/// Every object's shape, in place of all that was drawn before. `surfaces` may be empty, or have one for each
/// object; an object whose shape is neither there nor in the description is drawn as its name.
::foxglove::SceneUpdate draw_shapes(const v1::SceneDescription& scene, std::span<const Surface> surfaces,
                                    std::uint64_t time_ns);

/// Where objects and devices are; `devices` are the names in the order of the config.
::foxglove::FrameTransforms draw_places(const v1::SceneDescription& scene,
                                        std::span<const std::string> devices, const v1::Frame& frame);

/// HIPs as points, grey if free, green if they stick and orange if they slip, and an arrow for the force that
/// each gives to the user.
::foxglove::SceneUpdate draw_hips(const v1::Frame& frame);

/// An event in words.
::foxglove::Log log_of(const v1::Event& event, std::uint64_t time_ns);

}  // namespace haptic::view
