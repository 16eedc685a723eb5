// What a viewer of Foxglove's kind may say: a conversation of text and binary messages, each preceded by a
// byte that tells its length and whether it is text. Whatever comes: what waits for the viewer is bounded, is
// JSON or under one of its own subscriptions, and it gets nothing that it has not subscribed to.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "client/view/foxglove_viewer.h"

namespace {

using namespace haptic::gateway;

constexpr std::size_t kHeadBytes = 13;

void offer(FoxgloveViewer& viewer) {
  static const auto kPayload = std::make_shared<const std::string>("payload");
  for (std::size_t slot = 0; slot < kSlots; ++slot) {
    viewer.set(static_cast<Slot>(slot), kPayload, 1);
  }
  viewer.log(kPayload, 1);
}

void fetch(FoxgloveViewer& viewer) {
  std::size_t wanted = 0;
  for (std::uint32_t topic = 1; topic <= kTopics; ++topic) {
    wanted += viewer.wants(static_cast<Topic>(topic)) ? 1 : 0;
  }
  std::size_t count = 0;
  while (const auto next = viewer.take()) {
    if (++count > 2 * FoxgloveViewer::kMostWords + kSlots) std::abort();
    if (!next->payload && !nlohmann::json::accept(next->head)) std::abort();
    if (next->payload && (wanted == 0 || next->head.size() != kHeadBytes)) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view rest(reinterpret_cast<const char*>(data), size);
  FoxgloveViewer viewer;
  while (!rest.empty()) {
    const auto kind = static_cast<unsigned char>(rest.front());
    rest.remove_prefix(1);
    // 127: all that is left
    const std::size_t length =
        kind % 128U == 127U ? rest.size() : std::min<std::size_t>(kind % 128U, rest.size());
    const std::string_view message = rest.substr(0, length);
    rest.remove_prefix(length);
    if (kind < 128) {
      viewer.take_text(message);
    } else {
      viewer.take_bytes(message);
    }
    offer(viewer);
    if (viewer.lacks_shapes() && viewer.lacks_shapes()) std::abort();
    if (kind % 2 == 0) fetch(viewer);
  }
  fetch(viewer);
  return 0;
}
