// The promise: a client that only observes can never change a force. Every call of the schema is made, found
// by reflection, with every field set, against the real tick.

#include <google/protobuf/descriptor.h>
#include <gtest/gtest.h>

#include <cstring>

#include "ipc/dispatch.h"
#include "tests/support/servo_rig.h"
#include "tests/support/test_daemon.h"

namespace haptic::ipc {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

constexpr int kTicks = 400;

// every field of it, and of what lies in it; of a oneof the last one
void fill(Message& message, int depth = 0) {
  const auto& reflection = *message.GetReflection();
  for (int i = 0; i < message.GetDescriptor()->field_count(); ++i) {
    const FieldDescriptor* const field = message.GetDescriptor()->field(i);
    if (field->is_repeated()) {
      if (field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE && depth < 6) {
        fill(*reflection.AddMessage(&message, field), depth + 1);
      } else if (field->cpp_type() == FieldDescriptor::CPPTYPE_ENUM) {
        reflection.AddEnumValue(&message, field, 1);
      }
      continue;
    }
    switch (field->cpp_type()) {
      case FieldDescriptor::CPPTYPE_MESSAGE:
        if (depth < 6) {
          fill(*reflection.MutableMessage(&message, field), depth + 1);
        }
        break;
      case FieldDescriptor::CPPTYPE_UINT32:
        reflection.SetUInt32(&message, field, 3);
        break;
      case FieldDescriptor::CPPTYPE_UINT64:
        reflection.SetUInt64(&message, field, 1);
        break;
      case FieldDescriptor::CPPTYPE_BOOL:
        reflection.SetBool(&message, field, true);
        break;
      case FieldDescriptor::CPPTYPE_DOUBLE:
        reflection.SetDouble(&message, field, 0.5);
        break;
      case FieldDescriptor::CPPTYPE_STRING:
        reflection.SetString(&message, field, "wall");
        break;
      default:
        break;
    }
  }
}

// each call twice: as small as it can be, and with all that it can carry
std::vector<v1::Request> all_requests() {
  std::vector<v1::Request> requests;
  const auto* const calls = v1::Request::descriptor()->FindOneofByName("call");
  for (int i = 0; i < calls->field_count(); ++i) {
    for (const bool filled : {false, true}) {
      v1::Request& request = requests.emplace_back();
      request.set_id(42);
      Message* const call = request.GetReflection()->MutableMessage(&request, calls->field(i));
      if (filled) {
        fill(*call);
      }
    }
  }
  return requests;
}

// a hand that presses on a wall and slides, armed, while a client of this role asks; the bits of all forces
std::uint64_t forces_while_asked(v1::Role role, const std::vector<v1::Request>& requests) {
  servo::ServoSettings settings;
  settings.armed_from_start = true;
  test::ServoRig rig(settings);
  Services services{.mailbox = rig.mailbox(),
                    .version = "1.2",
                    .rate_hz = 1000.0,
                    .devices = {},
                    .real_time = {},
                    .scene = test::example_scene(),
                    .running = {},
                    .build_scene = test::build_example,
                    .edit_scene = {}};
  ServoLink link(rig.mailbox(), std::chrono::seconds(60), [](const servo::Event&) {});
  SceneStore scenes(services, link);
  Publisher publisher;
  publisher.learn(scenes.current());
  DriveLease lease(DrivePolicy(), link);
  Desk desk{services, link, scenes, publisher, SteadyClock::now(), [] { return std::size_t{1}; }, lease};
  Caller caller;
  caller.id = 1;
  caller.role = role;
  caller.sink = [](const OutgoingFrame&) {};
  caller.drop_frames = [](std::uint32_t) {};

  std::uint64_t hash = 14695981039346656037ULL;  // FNV-1a
  for (int tick = 0; tick < kTicks; ++tick) {
    const double t = tick * 1e-3;
    rig.device(0).sample.position = {0.01 + 0.05 * t, 0.02, 0.005 - 0.05 * t};
    if (tick % 4 == 0 && !requests.empty()) {
      const auto& request = requests[static_cast<std::size_t>(tick / 4) % requests.size()];
      dispatch(desk, caller, request, Reply(request.id(), [](v1::Response&&) {}));
    }
    rig.tick();
    link.poll(SteadyClock::now());
    publisher.drain(rig.mailbox().snapshots, [&] { publisher.learn(scenes.current()); });
    for (const std::size_t device : {0U, 1U}) {
      unsigned char bytes[sizeof(glm::dvec3)];
      std::memcpy(bytes, &rig.device(device).written.force, sizeof(bytes));
      for (const unsigned char byte : bytes) {
        hash = (hash ^ byte) * 1099511628211ULL;
      }
    }
  }
  lease.forget(1, SteadyClock::now());
  return hash;
}

TEST(Observer, NeverChangesAForceWhateverItAsks) {
  const std::vector<v1::Request> requests = all_requests();
  ASSERT_LE(requests.size() * 4, static_cast<std::size_t>(kTicks)) << "not all of them would be made";
  EXPECT_EQ(forces_while_asked(v1::OBSERVE, requests), forces_while_asked(v1::OBSERVE, {}));
}

// what the test above would see
TEST(Observer, IsToldApartFromOneWhoMayDisarm) {
  v1::Request disarm;
  disarm.mutable_disarm();
  EXPECT_EQ(forces_while_asked(v1::OBSERVE, {disarm}), forces_while_asked(v1::OBSERVE, {}));
  EXPECT_NE(forces_while_asked(v1::SCRIPT, {disarm}), forces_while_asked(v1::OBSERVE, {}));
}

}  // namespace
}  // namespace haptic::ipc
