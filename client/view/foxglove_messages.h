#pragma once
// The Foxglove WebSocket protocol, foxglove.websocket.v1 and what foxglove.sdk.v1 has in common with it: text
// is JSON, bytes begin with an opcode and are little-endian. Pure.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace haptic::gateway::foxglove_protocol {

struct Channel {
  std::uint32_t id = 0;
  std::string topic;
  std::string schema_name;
  std::string schema;  // a FileDescriptorSet
};

/// Standard base64 with padding.
std::string base64(std::string_view bytes);

// What the server says. Bytes that are no UTF-8 are replaced.

std::string server_info(std::string_view name, std::string_view session_id);
std::string advertise(std::span<const Channel> channels);

enum class Level { kInfo = 0, kWarning = 1, kError = 2 };
/// A status with an id replaces the one before; without one it stands alone.
std::string status(Level level, std::string_view message, std::string_view id = {});
std::string remove_status(std::string_view id);

/// What stands before a message's payload.
std::string message_head(std::uint32_t subscription, std::uint64_t log_time_ns);

// What a client says.

struct Subscription {
  std::uint32_t id = 0;  // chosen by the client
  std::uint32_t channel = 0;
};
struct Subscribe {
  std::vector<Subscription> subscriptions;
};
struct Unsubscribe {
  std::vector<std::uint32_t> ids;
};
/// Well said, but nothing that this server can do.
struct Unsupported {
  std::string what;
};
struct Invalid {
  std::string why;
};
struct Nothing {};
using Request = std::variant<Subscribe, Unsubscribe, Unsupported, Invalid, Nothing>;

Request parse_text(std::string_view text);
Request parse_bytes(std::string_view bytes);

}  // namespace haptic::gateway::foxglove_protocol
