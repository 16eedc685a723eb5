#pragma once
// What both sides of the wire agree on before the first byte: the version that each tells in its Hello, and
// the sizes that each accepts.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace haptic::proto {

/// Sides with different majors do not talk to each other. A minor only adds, and both sides ignore what they
/// do not know, so any two minors do.
inline constexpr std::uint32_t kProtocolMajor = 1;
inline constexpr std::uint32_t kProtocolMinor = 0;

/// All that Hello.feature can name; the daemon of this version has them all. A name stays for good.
inline constexpr std::array<std::string_view, 8> kFeatures = {
    "subscribe.filter",    // Subscribe.finger, object, only_in_contact
    "subscribe.delivery",  // Subscribe.delivery, Envelope.batch, ticks and topics in Gap
    "subscribe.events",    // topics EVENTS and STATS
    "replay",          // topic INPUTS, GetState, GetScene.embed_meshes and revision, SceneDescription.carry
    "device.move",     // MoveDevice
    "device.manage",   // ManageDevice, DEVICE_CHANGED, phase, reason, serial and losses of DeviceStatus
    "emergency_stop",  // EmergencyStop, Device.stop_button
    "faults",          // ListFaults, the event FAULT_RECORDED
};

/// The largest message that the daemon accepts from a peer that has not said Hello.
inline constexpr std::size_t kGreetingLimit = std::size_t{64} * 1024;

/// The largest message that the daemon accepts after Hello: a scene, without the meshes it names.
inline constexpr std::size_t kRequestLimit = std::size_t{1024} * 1024;

/// The largest message that a client accepts: a frame of 16384 HIPs, each held by several objects, is below
/// it.
inline constexpr std::size_t kReplyLimit = std::size_t{64} * 1024 * 1024;

}  // namespace haptic::proto
