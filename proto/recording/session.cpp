#include "proto/recording/session.h"

#include <google/protobuf/descriptor.h>

#include <charconv>

#include "proto/recording/schema_set.h"

namespace haptic::recording {
namespace {

constexpr std::uint64_t kDrawingPeriod = 20'000'000;   // ns
constexpr std::uint64_t kClockWasSet = 1'000'000'000;  // ns

std::string to_text(double number) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr};
}

}  // namespace

std::string channel_of(v1::Topic topic) {
  switch (topic) {
    case v1::OBJECTS:
      return "/haptic/objects";
    case v1::HIPS:
      return "/haptic/hips";
    case v1::DEVICES:
      return "/haptic/devices";
    case v1::EVENTS:
      return "/haptic/events";
    case v1::STATS:
      return "/haptic/stats";
    case v1::INPUTS:
      return "/haptic/inputs";
    default:
      return "";
  }
}

SessionWriter::SessionWriter(Sink& sink, const Session& session)
    : writer_(sink, {.library = session.program}), viewers_(session.viewers) {
  writer_.add(Metadata{kSessionMetadata,
                       {{"program", session.program},
                        {"daemon_version", session.daemon_version},
                        {"rate_hz", to_text(session.rate_hz)},
                        {"decimation", std::to_string(session.decimation)}}});
}

void SessionWriter::write(const v1::SceneDescription& scene, std::uint64_t time_ns,
                          std::span<const view::Surface> surfaces) {
  scene_ = scene;
  put(kSceneTopic, scene, scene.revision(), time_ns);
  if (viewers_) {
    put("/foxglove/shapes", view::draw_shapes(scene, surfaces, time_ns), 0, time_ns);
  }
}

void SessionWriter::write(const v1::DeviceList& devices, std::uint64_t time_ns) {
  devices_.clear();
  for (const v1::DeviceStatus& device : devices.device()) {
    devices_.push_back(device.description().name());
  }
  put(kDevicesTopic, devices, 0, time_ns);
}

void SessionWriter::write(const v1::WorldState& state, std::uint64_t time_ns) {
  put(kStateTopic, state, state.tick(), time_ns);
}

void SessionWriter::write(const v1::Gap& gap, std::uint64_t time_ns) { put(kGapsTopic, gap, 0, time_ns); }

void SessionWriter::write(const v1::Frame& frame) {
  v1::Frame part = frame;  // its head, and one part at a time
  part.clear_objects();
  part.clear_hips();
  part.clear_devices();
  part.clear_stats();
  part.clear_event();
  part.clear_inputs();
  if (frame.has_objects()) {
    *part.mutable_objects() = frame.objects();
    put_part(v1::OBJECTS, frame, part);
    part.clear_objects();
  }
  if (frame.has_hips()) {
    *part.mutable_hips() = frame.hips();
    put_part(v1::HIPS, frame, part);
    part.clear_hips();
  }
  if (frame.has_devices()) {
    *part.mutable_devices() = frame.devices();
    put_part(v1::DEVICES, frame, part);
    part.clear_devices();
  }
  if (frame.has_inputs()) {
    *part.mutable_inputs() = frame.inputs();
    put_part(v1::INPUTS, frame, part);
    part.clear_inputs();
  }
  if (frame.has_stats()) {
    *part.mutable_stats() = frame.stats();
    put_part(v1::STATS, frame, part);
    part.clear_stats();
  }
  if (frame.has_event()) {
    *part.mutable_event() = frame.event();
    put_part(v1::EVENTS, frame, part);
  }
  if (viewers_) {
    draw(frame);
  }
}

void SessionWriter::put_part(v1::Topic topic, const v1::Frame& frame, v1::Frame& part) {
  put(channel_of(topic), part, frame.sequence(), frame.realtime_ns());
}

void SessionWriter::draw(const v1::Frame& frame) {
  const std::uint64_t now = frame.realtime_ns();
  if (frame.has_event()) {
    put("/foxglove/log", view::log_of(frame.event(), now), frame.sequence(), now);
  }
  const bool shows = frame.has_objects() || frame.has_hips() || frame.has_devices();
  // when the clock was set back, too
  const bool due = now >= next_drawing_ || next_drawing_ - now > kDrawingPeriod;
  if (!shows || !due) {
    return;
  }
  next_drawing_ = now + kDrawingPeriod;
  if (frame.has_objects() || frame.has_devices()) {
    put("/foxglove/transforms", view::draw_places(scene_, devices_, frame), frame.sequence(), now);
  }
  if (frame.has_hips()) {
    put("/foxglove/hips", view::draw_hips(frame), frame.sequence(), now);
  }
}

void SessionWriter::put(const std::string& topic, const google::protobuf::Message& message,
                        std::uint64_t sequence, std::uint64_t time_ns) {
  const std::uint16_t id = channel(topic, *message.GetDescriptor());
  message.SerializeToString(&buffer_);
  const bool overtaken = time_ns < last_time_ && last_time_ - time_ns < kClockWasSet;
  last_time_ = overtaken ? last_time_ : time_ns;
  writer_.write({id, static_cast<std::uint32_t>(sequence), last_time_, time_ns, buffer_});
}

std::uint16_t SessionWriter::channel(const std::string& topic, const google::protobuf::Descriptor& type) {
  const auto known = channels_.find(topic);
  if (known != channels_.end()) {
    return known->second;
  }
  const auto [schema, is_new] =
      schemas_.try_emplace(type.full_name(), static_cast<std::uint16_t>(schemas_.size() + 1));
  if (is_new) {
    writer_.add(schema_of(type, schema->second));
  }
  const auto id = static_cast<std::uint16_t>(channels_.size() + 1);
  writer_.add(Channel{id, schema->second, topic, "protobuf", {}});
  channels_.emplace(topic, id);
  return id;
}

}  // namespace haptic::recording
