#pragma once
// Makes a scene ready to run, off the servo thread.

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "servo/mailbox.h"

namespace haptic::servo {

/// Reserves all that running `scene` needs and finds the device of each finger by its name; `devices` are in
/// the order of the device set. A finger whose device is not there touches nothing. Not real-time safe.
std::unique_ptr<PreparedScene> prepare_scene(std::shared_ptr<const engine::Scene> scene,
                                             std::uint64_t revision, std::span<const std::string> devices);

/// A buffer for kCopyState that fits the states of `scene`. Not real-time safe.
std::unique_ptr<StateCopy> copy_buffer(const engine::Scene& scene, std::uint64_t revision);

}  // namespace haptic::servo
