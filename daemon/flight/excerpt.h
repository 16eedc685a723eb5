#pragma once
// The ticks around a fault as a recording, which stands alone and is replayed as any other:
//
//     tape:     ... state ... tick tick | tick ... fault ... 0.1 s |
//                     |                 first_tick                end
//     file:           state, scene, and every tick from here to the end
//
// A thread of its own, which may take its time.

#include <cstdint>
#include <memory>
#include <vector>

#include "engine/scene.h"
#include "flight/tape.h"
#include "haptic/v1/control.pb.h"
#include "proto/recording/session.h"
#include "proto/recording/sink.h"

namespace haptic::flight {

/// A scene that runs or has run.
struct KeptScene {
  std::uint64_t from_tick = 0;                       // the first tick in which it ran
  std::shared_ptr<const v1::SceneDescription> told;  // as clients are told of it
  std::shared_ptr<const engine::Scene> built{};      // of it: where its meshes come from
};

struct Excerpt {
  recording::Session session;
  std::uint64_t first_tick = 0;   // that is wanted; it begins earlier where the state before lies earlier
  std::vector<Entry> entries;     // whose bytes stay until the writing is done; the oldest first
  std::vector<KeptScene> scenes;  // of all ticks that are wanted, the oldest first
  v1::DeviceList devices;
};

/// Throws recording::IoError when the sink fails.
void write(const Excerpt& excerpt, recording::Sink& sink);

}  // namespace haptic::flight
