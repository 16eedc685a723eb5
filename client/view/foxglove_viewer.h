#pragma once
// What one viewer of Foxglove's kind has subscribed to, and what waits for it. Of what comes often the newest
// takes the place of one that still waits; words wait in a short queue. Pure.
//
//     set(kPlaces, ...)     [tf]      . newest
//     set(kShapes, ...)     [shapes]  . newest, before HIPs: both are of the topic /scene
//     set(kHips, ...)       [HIPs]    . newest       --> take(): one after the other
//     ...
//     log(...)              [ ....... ] oldest go

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "client/view/foxglove_messages.h"
#include "client/view/web_socket.h"

namespace haptic::gateway {

/// The number of a topic's channel.
enum class Topic : std::uint32_t { kPlaces = 1, kScene = 2, kFrame = 3, kLog = 4, kStats = 5 };
inline constexpr std::size_t kTopics = 5;

/// What takes each other's place.
enum class Slot : std::size_t { kPlaces, kShapes, kHips, kFrame, kStats };
inline constexpr std::size_t kSlots = 5;

/// Each topic with its schema.
std::array<foxglove_protocol::Channel, kTopics> all_channels();

class FoxgloveViewer {
 public:
  static constexpr std::size_t kMostWords = 64;  // that wait in each queue

  /// What the viewer says, whose answers wait then like everything else.
  void take_text(std::string_view text) { take(foxglove_protocol::parse_text(text)); }
  void take_bytes(std::string_view bytes) { take(foxglove_protocol::parse_bytes(bytes)); }

  bool wants(Topic topic) const noexcept;
  /// Whether it has subscribed to the scene since this was asked last: then it has not yet got its shapes.
  bool lacks_shapes() noexcept;

  /// Without a subscription it is not kept.
  void set(Slot slot, Payload payload, std::uint64_t log_time_ns);
  void log(Payload payload, std::uint64_t log_time_ns);
  /// Text as it is.
  void tell(std::string text);

  /// What goes next, or nothing.
  std::optional<Outgoing> take();

 private:
  struct Waiting {
    Payload payload;
    std::uint64_t log_time_ns = 0;
  };

  void take(const foxglove_protocol::Request& request);
  void subscribe(const foxglove_protocol::Subscription& wish);
  void unsubscribe(std::uint32_t id);
  Outgoing pack(Topic topic, const Waiting& waiting) const;

  std::array<std::optional<std::uint32_t>, kTopics> subscriptions_;  // the viewer's number of each topic's
  std::array<Waiting, kSlots> slots_;
  std::size_t next_slot_ = 0;
  std::deque<std::string> texts_;
  std::deque<Waiting> logs_;
  bool lacks_shapes_ = false;
};

}  // namespace haptic::gateway
