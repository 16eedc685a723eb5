#include "client/cli/condition.h"

#include <gtest/gtest.h>

#include <sstream>

#include "client/lib/error.h"

namespace haptic::cli {
namespace {

std::vector<std::string> split(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) {
    words.push_back(word);
  }
  return words;
}

// a box at (0.1, 0.2, 0.3) with velocity (0, 0.3, 0.4), a thumb of two HIPs of which one is held and slips
Look example() {
  Look look;
  look.names.objects = {"floor", "my.box"};
  look.names.devices = {"left"};
  look.names.fingers.resize(1);
  look.names.fingers[0].set_name("thumb");
  look.names.fingers[0].set_hips(2);
  look.frame.set_tick(500);
  look.frame.set_armed(true);
  v1::ObjectsFrame& objects = *look.frame.mutable_objects();
  for (const double number : {0.0, 0.0, 0.0, 0.1, 0.2, 0.3}) {
    objects.add_position(number);
  }
  for (const double number : {0.0, 0.0, 0.0, 0.0, 0.3, 0.4}) {
    objects.add_velocity(number);
  }
  v1::HipsFrame& hips = *look.frame.mutable_hips();
  for (const double number : {1.0, 0.0, 0.0, 2.0, 4.0, 0.0}) {
    hips.add_position(0.0);
    hips.add_force(number);
  }
  hips.add_contact_hip(1);
  hips.add_contact_object(1);
  hips.add_contact_state(v1::SUR);
  hips.add_contact_slipping(true);
  for (const double number : {2.0, 4.0, 0.0}) {
    hips.add_contact_proxy(0.0);
    hips.add_contact_force(number);
  }
  v1::DevicesFrame& devices = *look.frame.mutable_devices();
  for (const double number : {0.5, 0.6, 0.7}) {
    devices.add_position(number);
    devices.add_force(0.0);
  }
  devices.add_present(true);
  devices.add_fault(v1::FAULT_NONE);
  return look;
}

bool true_of_example(const std::string& text) {
  const Condition condition = parse_condition(split(text));
  return holds(condition, measure(condition, example()));
}

std::string mistake(const std::string& text) {
  try {
    parse_condition(split(text));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no mistake";
}

TEST(Condition, MeasuresWhatItNames) {
  const auto measured = [](const std::string& subject) {
    return measure(parse_condition(split(subject + " > 0")), example());
  };
  EXPECT_EQ(measured("object my.box.y"), 0.2);
  EXPECT_EQ(measured("object my.box.vz"), 0.4);
  EXPECT_DOUBLE_EQ(measured("object my.box.speed"), 0.5);  // |(0, 0.3, 0.4)|
  EXPECT_DOUBLE_EQ(measured("finger thumb.force"), 5.0);   // |(1, 0, 0) + (2, 4, 0)|
  EXPECT_EQ(measured("finger thumb.touching"), 1.0);
  EXPECT_EQ(measured("finger thumb.slipping"), 1.0);
  EXPECT_EQ(measured("device left.z"), 0.7);
  EXPECT_EQ(measured("device left.force"), 0.0);
  EXPECT_EQ(measured("device left.armed"), 1.0);
  EXPECT_EQ(measured("tick"), 500.0);
}

TEST(Condition, ComparesAsItSays) {
  EXPECT_TRUE(true_of_example("tick < 501"));
  EXPECT_FALSE(true_of_example("tick < 500"));
  EXPECT_TRUE(true_of_example("tick <= 500"));
  EXPECT_FALSE(true_of_example("tick > 500"));
  EXPECT_TRUE(true_of_example("tick >= 500"));
  EXPECT_TRUE(true_of_example("tick == 500"));
  EXPECT_FALSE(true_of_example("tick == 499"));
  EXPECT_TRUE(true_of_example("object my.box.y == 0.25 within 0.051"));
  EXPECT_FALSE(true_of_example("object my.box.y == 0.25 within 0.049"));
  EXPECT_TRUE(true_of_example("object my.box.x > -1e3"));
}

TEST(Condition, OfACountHoldsUnlessItIsZero) {
  EXPECT_TRUE(true_of_example("finger thumb.touching"));
  EXPECT_TRUE(true_of_example("device left.armed == true"));
  EXPECT_FALSE(true_of_example("device left.armed == false"));
}

TEST(Condition, FaultyDevicesAreNotArmed) {
  Look look = example();
  look.frame.mutable_devices()->set_fault(0, v1::FAULT_OVER_SPEED);
  EXPECT_EQ(measure(parse_condition(split("device left.armed")), look), 0.0);
}

TEST(Condition, TellsWhatIsWrongWithIt) {
  EXPECT_EQ(mistake(""), "a condition is missing: object, finger, device or tick ...");
  EXPECT_EQ(mistake("box y > 1"), "'box' is none of object, finger, device, tick");
  EXPECT_EQ(mistake("object box > 1"),
            "'box' should be NAME.FIELD with one of the fields x, y, z, vx, vy, vz, speed");
  EXPECT_EQ(mistake("finger .force > 1"),
            "'.force' should be NAME.FIELD with one of the fields force, touching, slipping");
  EXPECT_EQ(mistake("object box.y"), "a comparison is missing: < <= > >= ==");
  EXPECT_EQ(mistake("object box.y = 1"), "'=' is none of < <= > >= ==");
  EXPECT_EQ(mistake("object box.y >"), "no number follows >");
  EXPECT_EQ(mistake("object box.y > 1m"), "'1m' is no number");
  EXPECT_EQ(mistake("object box.y > nan"), "'nan' is no number");
  EXPECT_EQ(mistake("object box.y == 1"), "== with a measured quantity needs: within TOLERANCE");
  EXPECT_EQ(mistake("object box.y > 1 within 2"), "only == has a tolerance");
  EXPECT_EQ(mistake("object box.y == 1 within -2"), "a tolerance is not negative");
  EXPECT_EQ(mistake("tick > 1 2"), "'2' is too much");
}

TEST(Condition, OfAnObjectThatIsNotThereIsNotFound) {
  EXPECT_THROW(true_of_example("object nobody.y > 0"), client::NotFound);
  EXPECT_THROW(true_of_example("finger nobody.force > 0"), client::NotFound);
  EXPECT_THROW(true_of_example("device nobody.force > 0"), client::NotFound);
}

TEST(Duration, HasAUnit) {
  EXPECT_EQ(parse_duration("2s"), 2.0);
  EXPECT_EQ(parse_duration("1.5min"), 90.0);
  EXPECT_DOUBLE_EQ(parse_duration("200ms"), 0.2);
  for (const char* wrong : {"", "2", "s", "-1s", "1e3s", "2 s", "1.2.3s", "2h", "1441min"}) {
    EXPECT_THROW(parse_duration(wrong), std::invalid_argument) << wrong;
  }
}

}  // namespace
}  // namespace haptic::cli
