#include "client/view/policy.h"

#include <google/protobuf/descriptor.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <string>

namespace haptic::gateway {
namespace {

// a request with this call and nothing in it
v1::Request request_of(const google::protobuf::FieldDescriptor& call) {
  v1::Request request;
  request.GetReflection()->MutableMessage(&request, &call);
  return request;
}

std::set<std::string> calls_that_pass(Rights rights) {
  std::set<std::string> names;
  const auto& calls = *v1::Request::descriptor()->oneof_decl(0);
  for (int i = 0; i < calls.field_count(); ++i) {
    v1::Request request = request_of(*calls.field(i));
    if (!judge(request, rights, 1)) {
      names.insert(calls.field(i)->name());
    }
  }
  return names;
}

const std::set<std::string> kObserving = {"get_status", "list_devices", "get_scene",  "get_stats",
                                          "subscribe",  "unsubscribe",  "list_faults"};

TEST(Policy, LetsAnObserverObserveAndNothingElse) {
  EXPECT_EQ(calls_that_pass(Rights::kObserve), kObserving);
}

TEST(Policy, LetsADriverDriveButNotChangeScenes) {
  std::set<std::string> expected = kObserving;
  expected.insert({"arm", "disarm", "move_device", "emergency_stop", "clear_fault", "pause", "resume", "step",
                   "reset_scene", "acquire_drive", "release_drive", "heartbeat"});
  EXPECT_EQ(calls_that_pass(Rights::kDrive), expected);
}

TEST(Policy, RefusesACallThatItDoesNotKnow) {
  v1::Request request;
  request.set_id(7);
  ASSERT_TRUE(request.ParseFromString(request.SerializeAsString() + std::string("\xa2\x3e\x00", 3)));
  const auto error = judge(request, Rights::kDrive, 1);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), v1::Error::REFUSED);
  EXPECT_NE(error->message(), "");
}

TEST(Policy, LeavesTheCountersOfOthersToDrivers) {
  v1::Request request;
  request.mutable_get_stats()->set_reset(true);
  EXPECT_TRUE(judge(request, Rights::kObserve, 1));
  EXPECT_FALSE(judge(request, Rights::kDrive, 1));
}

TEST(Policy, GivesEverySubscriptionTheNewestAndNoMoreThanAScreenShows) {
  for (const v1::Delivery delivery : {v1::DELIVERY_UNSPECIFIED, v1::LATEST, v1::LOSSLESS}) {
    v1::Request request;
    request.mutable_subscribe()->add_topic(v1::HIPS);
    request.mutable_subscribe()->set_delivery(delivery);
    ASSERT_FALSE(judge(request, Rights::kDrive, 17));
    EXPECT_EQ(request.subscribe().delivery(), v1::LATEST);
    EXPECT_EQ(request.subscribe().decimation(), 17U);
    EXPECT_EQ(request.subscribe().topic(0), v1::HIPS);
  }
}

TEST(Policy, LetsAPageHaveLessThanTheMost) {
  v1::Request request;
  request.mutable_subscribe()->add_topic(v1::HIPS);
  request.mutable_subscribe()->set_decimation(100);
  ASSERT_FALSE(judge(request, Rights::kObserve, 17));
  EXPECT_EQ(request.subscribe().decimation(), 100U);
}

TEST(Policy, GivesNoPageInputs) {
  v1::Request request;
  request.mutable_subscribe()->add_topic(v1::HIPS);
  request.mutable_subscribe()->add_topic(v1::INPUTS);
  const auto error = judge(request, Rights::kDrive, 1);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->field(), "topic");
}

TEST(LeastDecimation, IsTheFewestTicksThatKeepTheRate) {
  EXPECT_EQ(least_decimation(1000.0, 60.0), 17U);  // 1000 / 17 = 58.8; 1000 / 16 = 62.5
  EXPECT_EQ(least_decimation(1000.0, 62.5), 16U);
  EXPECT_EQ(least_decimation(4000.0, 60.0), 67U);
  EXPECT_EQ(least_decimation(50.0, 60.0), 1U);
  EXPECT_EQ(least_decimation(60.0, 60.0), 1U);
}

TEST(LeastDecimation, IsANumberWhateverTheDaemonTells) {
  EXPECT_EQ(least_decimation(0.0, 60.0), 1U);
  EXPECT_EQ(least_decimation(-1.0, 60.0), 1U);
  EXPECT_EQ(least_decimation(std::nan(""), 60.0), 1U);
  EXPECT_EQ(least_decimation(std::numeric_limits<double>::infinity(), 60.0), 1'000'000U);
}

TEST(Hello, TellsAPageNoMoreThanItMay) {
  v1::Hello daemon;
  daemon.set_role(v1::ADMIN);
  daemon.set_scene_revision(4);
  daemon.add_feature("subscribe.filter");
  daemon.add_feature("device.move");
  const v1::Hello observer = hello_for(Rights::kObserve, daemon);
  EXPECT_EQ(observer.role(), v1::OBSERVE);
  ASSERT_EQ(observer.feature_size(), 1);
  EXPECT_EQ(observer.feature(0), "subscribe.filter");
  EXPECT_EQ(observer.scene_revision(), 4U);
  EXPECT_EQ(hello_for(Rights::kDrive, daemon).SerializeAsString(), daemon.SerializeAsString());
}

TEST(Hello, TellsADriverNoMoreThanTheGatewayItselfMay) {
  v1::Hello daemon;
  daemon.set_role(v1::OBSERVE);
  daemon.add_feature("device.move");
  const v1::Hello driver = hello_for(Rights::kDrive, daemon);
  EXPECT_EQ(driver.role(), v1::OBSERVE);
  EXPECT_EQ(driver.feature_size(), 0);
}

}  // namespace
}  // namespace haptic::gateway
