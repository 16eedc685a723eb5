#include "ipc/dispatch.h"

#include <gtest/gtest.h>

#include <map>

#include "tests/support/test_daemon.h"

namespace haptic::ipc {
namespace {

// written down a second time on purpose: a change of the table must be meant
const std::map<std::string, v1::Role>& expected_roles() {
  static const std::map<std::string, v1::Role> kRoles = {
      {"get_status", v1::OBSERVE},  {"list_devices", v1::OBSERVE}, {"get_scene", v1::OBSERVE},
      {"load_scene", v1::SCRIPT},   {"reset_scene", v1::SCRIPT},   {"arm", v1::DRIVE},
      {"disarm", v1::SCRIPT},       {"pause", v1::SCRIPT},         {"resume", v1::SCRIPT},
      {"step", v1::SCRIPT},         {"get_stats", v1::OBSERVE},    {"subscribe", v1::OBSERVE},
      {"unsubscribe", v1::OBSERVE}, {"clear_fault", v1::ADMIN},    {"edit_scene", v1::SCRIPT},
      {"acquire_drive", v1::DRIVE}, {"release_drive", v1::DRIVE},  {"heartbeat", v1::DRIVE},
      {"move_device", v1::DRIVE},   {"get_state", v1::OBSERVE},    {"manage_device", v1::DRIVE}};
  return kRoles;
}

std::vector<std::string> all_calls() {
  std::vector<std::string> names;
  const auto* oneof = v1::Request::descriptor()->FindOneofByName("call");
  for (int i = 0; i < oneof->field_count(); ++i) {
    names.push_back(oneof->field(i)->name());
  }
  return names;
}

v1::Request request_of(const std::string& call) {
  v1::Request request;
  request.set_id(42);
  request.GetReflection()->MutableMessage(&request, v1::Request::descriptor()->FindFieldByName(call));
  return request;
}

// what handlers work with, without sockets or threads
class Office {
 public:
  explicit Office(std::size_t commands_before = 0)
      : mailbox_(std::make_unique<servo::Mailbox>(servo::Capacity{4, 4, 4, 4, 4})),
        services_{.mailbox = *mailbox_,
                  .version = "1.2",
                  .rate_hz = 1000.0,
                  .devices = {},
                  .real_time = {},
                  .scene = test::example_scene(),
                  .running = {},
                  .build_scene = test::build_example,
                  .edit_scene = test::edit_example} {
    for (std::size_t i = 0; i < commands_before; ++i) {
      mailbox_->commands.push({});
    }
  }

  std::optional<v1::Response> ask(const v1::Request& request, v1::Role role) {
    std::optional<v1::Response> answer;
    Caller caller;
    caller.id = 1;
    caller.role = role;
    caller.drop_frames = [](std::uint32_t) {};
    dispatch(desk_, caller, request, Reply(request.id(), [&](v1::Response&& response) {
               EXPECT_FALSE(answer) << "two answers";
               answer = std::move(response);
             }));
    last_answer_ = answer;
    return answer;
  }

  std::size_t commands() const { return mailbox_->commands.read_available(); }
  Publisher& publisher() { return publisher_; }

 private:
  std::unique_ptr<servo::Mailbox> mailbox_;
  Services services_;
  ServoLink servo_{*mailbox_, std::chrono::seconds(1), [](const servo::Event&) {}};
  SceneStore scenes_{services_, servo_};
  Publisher publisher_;
  DriveLease lease_{DrivePolicy(), servo_};
  Desk desk_{services_, servo_, scenes_, publisher_, SteadyClock::now(), [] { return std::size_t{3}; },
             lease_};
  std::optional<v1::Response> last_answer_;
};

TEST(Dispatch, KnowsEveryCallOfTheSchema) {
  for (const std::string& call : all_calls()) {
    EXPECT_NE(least_role(request_of(call)), v1::ROLE_UNSPECIFIED) << call;
    EXPECT_EQ(expected_roles().count(call), 1U) << call;
  }
}

TEST(Dispatch, RefusesARequestWithoutAKnownCall) {
  Office office;
  v1::Request request;
  request.set_id(42);
  const auto answer = office.ask(request, v1::ADMIN);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->id(), 42U);
  EXPECT_EQ(answer->error().code(), v1::Error::UNSUPPORTED);
}

// one test for each call and role
struct Right {
  std::string call;
  v1::Role role;
};

std::vector<Right> all_rights() {
  std::vector<Right> rights;
  for (const std::string& call : all_calls()) {
    for (const v1::Role role : {v1::OBSERVE, v1::SCRIPT, v1::DRIVE, v1::ADMIN}) {
      rights.push_back({call, role});
    }
  }
  return rights;
}

class RightsTest : public testing::TestWithParam<Right> {};

TEST_P(RightsTest, AreThoseOfTheTable) {
  Office office;
  // a refused call is answered at once and leaves nothing for the servo thread
  const auto answer = office.ask(request_of(GetParam().call), GetParam().role);
  const bool refused = answer && answer->error().code() == v1::Error::REFUSED;
  EXPECT_EQ(refused, GetParam().role < expected_roles().at(GetParam().call));
  if (refused) {
    EXPECT_EQ(answer->id(), 42U);
    EXPECT_EQ(office.commands(), 0U);
  }
}

INSTANTIATE_TEST_SUITE_P(EachCallAndRole, RightsTest, testing::ValuesIn(all_rights()), [](const auto& right) {
  return right.param.call + "_as_" + v1::Role_Name(right.param.role);
});

TEST(Dispatch, LetsNobodyWhoOnlyObservesClearTheCounters) {
  Office office;
  v1::Request request = request_of("get_stats");
  request.mutable_get_stats()->set_reset(true);
  EXPECT_EQ(office.ask(request, v1::OBSERVE)->error().code(), v1::Error::REFUSED);
  EXPECT_FALSE(office.ask(request, v1::SCRIPT));  // waits for the servo thread
  EXPECT_EQ(office.commands(), 1U);
}

TEST(Dispatch, SaysBusyWhenTheServosQueueIsFull) {
  Office office(256);  // the queue's capacity
  for (const char* call : {"arm", "disarm", "pause", "step", "reset_scene", "clear_fault"}) {
    const auto answer = office.ask(request_of(call), v1::ADMIN);
    ASSERT_TRUE(answer) << call;
    EXPECT_EQ(answer->error().code(), v1::Error::BUSY) << call;
  }
}

TEST(Dispatch, AnswersStatusFromTheNewestSnapshot) {
  Office office;
  servo::Snapshot snapshot;
  snapshot.tick = 77;
  snapshot.armed = true;
  snapshot.missed_ticks = 5;
  office.publisher().publish(snapshot);
  const auto answer = office.ask(request_of("get_status"), v1::OBSERVE);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status().tick(), 77U);
  EXPECT_TRUE(answer->status().armed());
  EXPECT_EQ(answer->status().missed_ticks(), 5U);
  EXPECT_EQ(answer->status().clients(), 3U);
  EXPECT_EQ(answer->status().hips(), 2U);
  EXPECT_EQ(answer->status().scene(), "example");
}

TEST(Dispatch, TellsAFaultOfTheWholeDaemonOnce) {
  Office office;
  servo::Snapshot snapshot;
  servo::DeviceSnapshot device{};
  device.fault.kind = safety::FaultKind::kMissedTicks;
  snapshot.devices = {device, device};
  office.publisher().publish(snapshot);
  EXPECT_EQ(office.ask(request_of("get_status"), v1::OBSERVE)->status().fault_size(), 1);
}

TEST(Dispatch, RefusesSubscriptionsWithoutOrWithUnknownTopics) {
  Office office;
  v1::Request request = request_of("subscribe");
  EXPECT_EQ(office.ask(request, v1::OBSERVE)->error().code(), v1::Error::INVALID);
  request.mutable_subscribe()->add_topic(static_cast<v1::Topic>(99));
  EXPECT_EQ(office.ask(request, v1::OBSERVE)->error().code(), v1::Error::INVALID);
}

TEST(Dispatch, NamesTheFieldOfAFilterThatFindsNothing) {
  Office office;
  v1::Request request = request_of("subscribe");
  v1::Subscribe& wish = *request.mutable_subscribe();
  wish.add_topic(v1::HIPS);
  wish.add_finger("thumb");
  wish.add_finger("toe");
  v1::Error error = office.ask(request, v1::OBSERVE)->error();
  EXPECT_EQ(error.code(), v1::Error::NOT_FOUND);
  EXPECT_EQ(error.field(), "subscribe.finger[1]");
  EXPECT_EQ(error.message(), "the scene has no finger \"toe\"");
  wish.mutable_finger()->RemoveLast();
  wish.add_object("moon");
  error = office.ask(request, v1::OBSERVE)->error();
  EXPECT_EQ(error.code(), v1::Error::NOT_FOUND);
  EXPECT_EQ(error.field(), "subscribe.object[0]");
  wish.set_object(0, "block");
  EXPECT_FALSE(office.ask(request, v1::OBSERVE)->has_error());
}

TEST(Dispatch, RefusesAnUnknownDeliveryAndTooManyNames) {
  Office office;
  v1::Request request = request_of("subscribe");
  v1::Subscribe& wish = *request.mutable_subscribe();
  wish.add_topic(v1::STATS);
  wish.set_delivery(static_cast<v1::Delivery>(9));
  EXPECT_EQ(office.ask(request, v1::OBSERVE)->error().field(), "subscribe.delivery");
  wish.set_delivery(v1::LOSSLESS);
  for (int i = 0; i < 1025; ++i) {
    wish.add_object("block");
  }
  EXPECT_EQ(office.ask(request, v1::OBSERVE)->error().code(), v1::Error::INVALID);
  wish.mutable_object()->RemoveLast();
  EXPECT_FALSE(office.ask(request, v1::OBSERVE)->has_error());
}

TEST(Dispatch, BoundsTheSubscriptionsOfAClient) {
  Office office;
  v1::Request request = request_of("subscribe");
  request.mutable_subscribe()->add_topic(v1::OBJECTS);
  int granted = 0;
  while (granted < 1000 && !office.ask(request, v1::OBSERVE)->has_error()) {
    ++granted;
  }
  EXPECT_EQ(granted, 16);
}

TEST(Dispatch, CannotEndASubscriptionThatIsNotThere) {
  Office office;
  v1::Request request = request_of("unsubscribe");
  request.mutable_unsubscribe()->set_subscription(9);
  EXPECT_EQ(office.ask(request, v1::OBSERVE)->error().code(), v1::Error::NOT_FOUND);
}

}  // namespace
}  // namespace haptic::ipc
