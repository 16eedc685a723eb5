#pragma once
// A recording of a daemon that never ran: a scene with a finger of two HIPs and a box, and frames one ms
// apart.

#include <functional>
#include <string>

#include "proto/recording/session.h"
#include "proto/recording/sink.h"

namespace haptic::test {

inline constexpr std::uint64_t kRecordingStart = 5'000'000'000;  // ns
inline constexpr std::uint64_t kFirstTick = 7000;                // the daemon has run for 7 s by then

/// A frame so many ms after the start, with nothing in it yet.
inline v1::Frame frame_after(std::uint64_t milliseconds) {
  v1::Frame frame;
  frame.set_sequence(milliseconds + 1);
  frame.set_tick(kFirstTick + milliseconds);
  frame.set_realtime_ns(kRecordingStart + 1'000'000 * milliseconds);
  frame.set_scene_revision(1);
  return frame;
}

/// A frame in which "thumb"'s two HIPs apply forces along y and x, in N; the second to the box only if not 0.
inline v1::Frame hips_after(std::uint64_t milliseconds, double normal, double tangential) {
  v1::Frame frame = frame_after(milliseconds);
  v1::HipsFrame& hips = *frame.mutable_hips();
  const double forces[2][3] = {{0.0, normal, 0.0}, {tangential, 0.0, 0.0}};
  for (std::uint32_t hip = 0; hip < 2; ++hip) {
    const bool touches = hip == 0 || tangential != 0.0;
    if (touches) {
      hips.add_contact_hip(hip);
      hips.add_contact_object(0);
      hips.add_contact_state(v1::SUR);
      hips.add_contact_slipping(false);
    }
    for (const double component : forces[hip]) {
      hips.add_position(0.0);
      hips.add_force(component);
      if (touches) {
        hips.add_contact_proxy(0.0);
        hips.add_contact_force(component);
      }
    }
  }
  return frame;
}

/// Writes what `fill` does to a file, behind the scene.
inline void write_session(const std::string& path,
                          const std::function<void(recording::SessionWriter&)>& fill) {
  recording::FileSink sink(path, recording::FileSink::IfThere::kReplace, recording::FileSink::Durable::kNo);
  recording::SessionWriter writer(
      sink,
      {.program = "test", .daemon_version = "0.1.0", .rate_hz = 1000.0, .decimation = 1, .viewers = false});
  v1::SceneDescription scene;
  scene.set_revision(1);
  scene.add_object()->set_name("box");
  v1::SceneDescription::FingerDescription& finger = *scene.add_finger();
  finger.set_name("thumb");
  finger.set_hips(2);
  writer.write(scene, kRecordingStart);
  fill(writer);
  writer.close();
  sink.close();
}

}  // namespace haptic::test
