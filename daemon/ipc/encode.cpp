#include "ipc/encode.h"

#include <time.h>

#include "ipc/convert.h"
#include "proto/framing.h"

namespace haptic::ipc {
namespace {

// tags of the wire format: number * 8 + type, where 0 is a varint and 2 a length with as many bytes
constexpr char kEnvelopeFrame = 4 * 8 + 2;
constexpr char kEnvelopeBatch = 8 * 8 + 2;
constexpr char kBatchFrame = 1 * 8 + 2;
constexpr char kFrameSequence = 1 * 8;
constexpr char kFrameSubscription = 2 * 8;
static_assert(v1::Envelope::kFrameFieldNumber == 4);
static_assert(v1::Envelope::kBatchFieldNumber == 8);
static_assert(v1::FrameBatch::kFrameFieldNumber == 1);
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

void fill_objects(const servo::Snapshot& snapshot, const Selection& selection, v1::ObjectsFrame& out) {
  for (std::size_t i = 0; i < snapshot.objects.size(); ++i) {
    if (!selection.has_object(i)) {
      continue;
    }
    const servo::ObjectSnapshot& object = snapshot.objects[i];
    add(*out.mutable_position(), object.position);
    add(*out.mutable_orientation(), object.orientation);
    add(*out.mutable_velocity(), object.velocity);
    add(*out.mutable_angular_velocity(), object.angular_velocity);
    add(*out.mutable_force(), object.force);
    add(*out.mutable_torque(), object.torque);
    if (!selection.all_objects) {
      out.add_object(static_cast<std::uint32_t>(i));
    }
  }
}

bool is_selected(const servo::ContactSnapshot& contact, const Selection& selection) {
  return selection.has_hip(contact.hip) && selection.has_object(contact.object) &&
         (!selection.only_in_contact || is_contact(contact));
}

// contacts in any order: HIPs are told in the order of their numbers
std::vector<bool> touching_hips(const servo::Snapshot& snapshot, const Selection& selection) {
  std::vector<bool> touching(snapshot.hips.size());
  for (const servo::ContactSnapshot& contact : snapshot.contacts) {
    if (contact.hip < touching.size() && is_selected(contact, selection)) {
      touching[contact.hip] = true;
    }
  }
  return touching;
}

void fill_hips(const servo::Snapshot& snapshot, const Selection& selection, v1::HipsFrame& out) {
  const bool all = selection.all_hips && !selection.only_in_contact;
  const std::vector<bool> touching =
      selection.only_in_contact ? touching_hips(snapshot, selection) : std::vector<bool>();
  for (std::size_t i = 0; i < snapshot.hips.size(); ++i) {
    if (!(selection.only_in_contact ? touching[i] : selection.has_hip(i))) {
      continue;
    }
    add(*out.mutable_position(), snapshot.hips[i].position);
    add(*out.mutable_force(), snapshot.hips[i].force);
    if (!all) {
      out.add_hip(static_cast<std::uint32_t>(i));
    }
  }
  for (const servo::ContactSnapshot& contact : snapshot.contacts) {
    if (!is_selected(contact, selection)) {
      continue;
    }
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
    add(*out.mutable_acceleration(), device.acceleration);
    out.add_limits(device.limits);
    out.add_energy(device.energy);
    out.add_phase(phase_of(device));
  }
}

v1::InputsFrame::Kind to_wire(servo::CommandKind kind) noexcept {
  switch (kind) {
    case servo::CommandKind::kPause:
      return v1::InputsFrame::PAUSE;
    case servo::CommandKind::kResume:
      return v1::InputsFrame::RESUME;
    case servo::CommandKind::kStep:
      return v1::InputsFrame::STEP;
    case servo::CommandKind::kReset:
      return v1::InputsFrame::RESET;
    case servo::CommandKind::kSwapScene:
      return v1::InputsFrame::SCENE;
    default:
      return v1::InputsFrame::KIND_UNSPECIFIED;
  }
}

void fill_inputs(const servo::Snapshot& snapshot, v1::InputsFrame& out) {
  for (const servo::DeviceSnapshot& device : snapshot.devices) {
    add(*out.mutable_position(), device.position);
    add(*out.mutable_orientation(), device.orientation);
    add(*out.mutable_velocity(), device.velocity);
    out.add_present(device.present);
  }
  const servo::TickInputs& inputs = snapshot.inputs;
  out.set_missed(inputs.missed);
  for (std::size_t i = 0; i < inputs.command_count; ++i) {
    v1::InputsFrame::Command& command = *out.add_command();
    command.set_kind(to_wire(inputs.commands[i].kind));
    command.set_ticks(inputs.commands[i].ticks);
    command.set_scene_revision(inputs.commands[i].revision);
  }
  out.set_state_hash(inputs.state_hash);
}

std::int64_t nanoseconds_of(clockid_t clock) noexcept {
  timespec now{};
  ::clock_gettime(clock, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

// of its fields, the shared ones included
std::size_t frame_size(const FrameHead& head) {
  return 1 + proto::varint_size(head.sequence) + 1 + proto::varint_size(head.subscription) + head.body_size;
}

void append_head(char tag, const FrameHead& head, std::string& out) {
  out.push_back(tag);
  proto::append_varint(frame_size(head), out);
  out.push_back(kFrameSequence);
  proto::append_varint(head.sequence, out);
  out.push_back(kFrameSubscription);
  proto::append_varint(head.subscription, out);
}

}  // namespace

void fill_frame(const servo::Snapshot& snapshot, TopicSet topics, const Selection& selection,
                std::int64_t offset_ns, v1::Frame& frame) {
  frame.Clear();
  frame.set_tick(snapshot.tick);
  frame.set_monotonic_ns(snapshot.monotonic_ns);
  frame.set_realtime_ns(snapshot.monotonic_ns + static_cast<std::uint64_t>(offset_ns));
  frame.set_scene_revision(snapshot.scene_revision);
  frame.set_armed(snapshot.armed);
  frame.set_paused(snapshot.paused);
  if ((topics & topic_bit(v1::OBJECTS)) != 0) {
    fill_objects(snapshot, selection, *frame.mutable_objects());
  }
  if ((topics & topic_bit(v1::HIPS)) != 0) {
    fill_hips(snapshot, selection, *frame.mutable_hips());
  }
  if ((topics & topic_bit(v1::DEVICES)) != 0) {
    fill_devices(snapshot, *frame.mutable_devices());
  }
  if ((topics & topic_bit(v1::INPUTS)) != 0) {
    fill_inputs(snapshot, *frame.mutable_inputs());
  }
}

void append_frame_head(std::uint64_t sequence, std::uint32_t subscription, std::size_t body_size,
                       std::string& out) {
  const FrameHead head{sequence, subscription, body_size};
  const std::size_t size = frame_size(head);
  proto::append_varint(1 + proto::varint_size(size) + size, out);
  append_head(kEnvelopeFrame, head, out);
}

std::vector<std::string> batch_heads(std::span<const FrameHead> frames) {
  std::size_t batch_size = 0;
  for (const FrameHead& frame : frames) {
    batch_size += 1 + proto::varint_size(frame_size(frame)) + frame_size(frame);
  }
  std::vector<std::string> heads(frames.size());
  proto::append_varint(1 + proto::varint_size(batch_size) + batch_size, heads.front());
  heads.front().push_back(kEnvelopeBatch);
  proto::append_varint(batch_size, heads.front());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    append_head(kBatchFrame, frames[i], heads[i]);
  }
  return heads;
}

std::int64_t realtime_offset_ns() noexcept {
  return nanoseconds_of(CLOCK_REALTIME) - nanoseconds_of(CLOCK_MONOTONIC);
}

std::uint64_t monotonic_ns() noexcept { return static_cast<std::uint64_t>(nanoseconds_of(CLOCK_MONOTONIC)); }

}  // namespace haptic::ipc
