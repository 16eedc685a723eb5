#include "ipc/encode.h"

#include <time.h>

#include "ipc/convert.h"
#include "proto/framing.h"

namespace haptic::ipc {
namespace {

// tags of the wire format: number * 8 + type, where 0 is a varint and 2 a length with as many bytes
constexpr char kEnvelopeFrame = 4 * 8 + 2;
constexpr char kFrameSequence = 1 * 8;
constexpr char kFrameSubscription = 2 * 8;
static_assert(v1::Envelope::kFrameFieldNumber == 4);
static_assert(v1::Frame::kSequenceFieldNumber == 1);
static_assert(v1::Frame::kSubscriptionFieldNumber == 2);

using Doubles = google::protobuf::RepeatedField<double>;

void add(Doubles& out, const glm::dvec3& v) {
  out.Add(v.x);
  out.Add(v.y);
  out.Add(v.z);
}

void add(Doubles& out, const glm::dquat& q) {
  out.Add(q.w);
  out.Add(q.x);
  out.Add(q.y);
  out.Add(q.z);
}

void fill_objects(const servo::Snapshot& snapshot, v1::ObjectsFrame& out) {
  for (const servo::ObjectSnapshot& object : snapshot.objects) {
    add(*out.mutable_position(), object.position);
    add(*out.mutable_orientation(), object.orientation);
    add(*out.mutable_velocity(), object.velocity);
    add(*out.mutable_angular_velocity(), object.angular_velocity);
    add(*out.mutable_force(), object.force);
    add(*out.mutable_torque(), object.torque);
  }
}

void fill_hips(const servo::Snapshot& snapshot, v1::HipsFrame& out) {
  for (const servo::HipSnapshot& hip : snapshot.hips) {
    add(*out.mutable_position(), hip.position);
    add(*out.mutable_force(), hip.force);
  }
  for (const servo::ContactSnapshot& contact : snapshot.contacts) {
    out.add_contact_hip(contact.hip);
    out.add_contact_object(contact.object);
    out.add_contact_state(to_wire(contact.state));
    out.add_contact_slipping(contact.slipping);
    add(*out.mutable_contact_proxy(), contact.proxy);
    add(*out.mutable_contact_force(), contact.force);
  }
}

void fill_devices(const servo::Snapshot& snapshot, v1::DevicesFrame& out) {
  for (const servo::DeviceSnapshot& device : snapshot.devices) {
    add(*out.mutable_position(), device.position);
    add(*out.mutable_orientation(), device.orientation);
    add(*out.mutable_velocity(), device.velocity);
    add(*out.mutable_force(), device.force);
    add(*out.mutable_torque(), device.torque);
    out.add_sample_age(device.sample_age);
    out.add_buttons(device.buttons);
    out.add_present(device.present);
    out.add_fault(to_wire(device.fault.kind));
  }
}

std::int64_t nanoseconds_of(clockid_t clock) noexcept {
  timespec now{};
  ::clock_gettime(clock, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

}  // namespace

void fill_frame(const servo::Snapshot& snapshot, TopicSet topics, std::int64_t offset_ns, v1::Frame& frame) {
  frame.Clear();
  frame.set_tick(snapshot.tick);
  frame.set_monotonic_ns(snapshot.monotonic_ns);
  frame.set_realtime_ns(snapshot.monotonic_ns + static_cast<std::uint64_t>(offset_ns));
  frame.set_scene_revision(snapshot.scene_revision);
  frame.set_armed(snapshot.armed);
  frame.set_paused(snapshot.paused);
  if ((topics & topic_bit(v1::OBJECTS)) != 0) {
    fill_objects(snapshot, *frame.mutable_objects());
  }
  if ((topics & topic_bit(v1::HIPS)) != 0) {
    fill_hips(snapshot, *frame.mutable_hips());
  }
  if ((topics & topic_bit(v1::DEVICES)) != 0) {
    fill_devices(snapshot, *frame.mutable_devices());
  }
}

void append_frame_head(std::uint64_t sequence, std::uint32_t subscription, std::size_t body_size,
                       std::string& out) {
  const std::size_t frame_size =
      1 + proto::varint_size(sequence) + 1 + proto::varint_size(subscription) + body_size;
  proto::append_varint(1 + proto::varint_size(frame_size) + frame_size, out);
  out.push_back(kEnvelopeFrame);
  proto::append_varint(frame_size, out);
  out.push_back(kFrameSequence);
  proto::append_varint(sequence, out);
  out.push_back(kFrameSubscription);
  proto::append_varint(subscription, out);
}

std::int64_t realtime_offset_ns() noexcept {
  return nanoseconds_of(CLOCK_REALTIME) - nanoseconds_of(CLOCK_MONOTONIC);
}

}  // namespace haptic::ipc
