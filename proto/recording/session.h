#pragma once
// What a recording of hapticd holds, and how it is written: the one place where topics are named.
//
//     /haptic/objects, /haptic/hips, /haptic/devices, /haptic/events, /haptic/stats
//                              haptic.v1.Frame, each with its part of what the daemon told
//     /haptic/scene            haptic.v1.SceneDescription: at the start, and whenever another scene runs
//     /haptic/inputs           haptic.v1.Frame: all that the state of its tick follows from
//     /haptic/state            haptic.v1.WorldState: where a replay of the inputs starts
//     /haptic/device_list      haptic.v1.DeviceList
//     /haptic/gaps             haptic.v1.Gap: what was lost on the way
//     /foxglove/transforms     foxglove.FrameTransforms
//     /foxglove/shapes         foxglove.SceneUpdate, whenever the scene changes
//     /foxglove/hips           foxglove.SceneUpdate
//     /foxglove/log            foxglove.Log
//
// Those below /foxglove are for viewers (proto/foxglove/scene_view.h), transforms and HIPs 50 times a second.
// The metadata "hapticd" tell who recorded what (Session). publish_time is the
// realtime_ns of the frame; log_time is the same, but never before that of the message before it, as
// statistics and events overtake frames by some milliseconds. It goes back only when the clock was set back
// by a second or more.

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "haptic/v1/control.pb.h"
#include "proto/foxglove/scene_view.h"
#include "proto/recording/writer.h"

namespace haptic::recording {

inline constexpr const char* kSceneTopic = "/haptic/scene";
inline constexpr const char* kStateTopic = "/haptic/state";
inline constexpr const char* kDevicesTopic = "/haptic/device_list";
inline constexpr const char* kGapsTopic = "/haptic/gaps";
inline constexpr const char* kSessionMetadata = "hapticd";

/// Where frames of a topic go; empty for a topic that is not known.
std::string channel_of(v1::Topic topic);

/// Who recorded what.
struct Session {
  std::string program;         // that records, with its version
  std::string daemon_version;  // of what it records
  double rate_hz = 0.0;        // of ticks
  std::uint32_t decimation = 1;
  bool viewers = true;  // with the topics below /foxglove
};

class SessionWriter {
 public:
  /// As Writer, whose rules hold for all functions here; `sink` is empty and outlives this.
  SessionWriter(Sink& sink, const Session& session);

  /// What the indices of frames mean from now on. `surfaces` as in draw_shapes().
  void write(const v1::SceneDescription& scene, std::uint64_t time_ns,
             std::span<const view::Surface> surfaces = {});
  void write(const v1::DeviceList& devices, std::uint64_t time_ns);
  /// Where a replay of the inputs that follow can start.
  void write(const v1::WorldState& state, std::uint64_t time_ns);

  /// Each topic that is in it, to its channel.
  void write(const v1::Frame& frame);

  void write(const v1::Gap& gap, std::uint64_t time_ns);

  void flush() { writer_.flush(); }
  void close() { writer_.close(); }

  const Writer& writer() const noexcept { return writer_; }

 private:
  std::uint16_t channel(const std::string& topic, const google::protobuf::Descriptor& type);
  void put(const std::string& topic, const google::protobuf::Message& message, std::uint64_t sequence,
           std::uint64_t time_ns);
  void put_part(v1::Topic topic, const v1::Frame& frame, v1::Frame& part);
  void draw(const v1::Frame& frame);

  Writer writer_;
  bool viewers_;
  std::map<std::string, std::uint16_t> channels_;  // by topic
  std::map<std::string, std::uint16_t> schemas_;   // by type
  v1::SceneDescription scene_;
  std::vector<std::string> devices_;
  std::uint64_t last_time_ = 0;  // log_time of the last message
  std::uint64_t next_drawing_ = 0;
  std::string buffer_;
};

}  // namespace haptic::recording
