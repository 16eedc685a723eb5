// What a subscriber costs the io thread: a tick of N HIPs, all in contact, as bytes of the wire, and what
// each further subscriber of the same costs once these are there. At 1 kHz a tick has 1 ms.

#include <benchmark/benchmark.h>

#include <string>

#include "ipc/encode.h"

namespace haptic::ipc {
namespace {

servo::Snapshot tick_of(std::size_t hips) {
  servo::Snapshot snapshot;
  snapshot.tick = 123'456;
  snapshot.monotonic_ns = 123'456'000'000;
  snapshot.scene_revision = 1;
  for (std::uint32_t i = 0; i < hips; ++i) {
    const glm::dvec3 place{1e-3 * i, 0.0123, -0.0456};
    snapshot.hips.push_back({.position = place, .force = {0.0, 0.1, 0.2}});
    snapshot.contacts.push_back({.hip = i,
                                 .object = 0,
                                 .state = engine::ConstraintState::kSur,
                                 .slipping = false,
                                 .proxy = place,
                                 .force = {0.0, 0.1, 0.2}});
  }
  return snapshot;
}

void encode_tick(benchmark::State& state) {
  const servo::Snapshot snapshot = tick_of(static_cast<std::size_t>(state.range(0)));
  v1::Frame frame;
  std::string bytes;
  for (auto _ : state) {
    frame.Clear();
    fill_frame(snapshot, topic_bit(v1::HIPS), Selection(), 0, frame);
    bytes.clear();
    frame.AppendToString(&bytes);
    benchmark::DoNotOptimize(bytes.data());
  }
  state.counters["bytes"] = static_cast<double>(bytes.size());
}
BENCHMARK(encode_tick)->Arg(22)->Arg(1000)->Arg(10'000);

void head_of_a_further_subscriber(benchmark::State& state) {
  std::string bytes;
  for (auto _ : state) {
    bytes.clear();
    append_frame_head(123'456, 7, static_cast<std::size_t>(state.range(0)), bytes);
    benchmark::DoNotOptimize(bytes.data());
  }
}
BENCHMARK(head_of_a_further_subscriber)->Arg(2'000)->Arg(100'000);

}  // namespace
}  // namespace haptic::ipc
