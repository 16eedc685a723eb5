#include "client/cli/tables.h"

#include <gtest/gtest.h>

namespace haptic::cli {
namespace {

Names example_names() {
  Names names;
  names.objects = {"block"};
  auto& thumb = names.fingers.emplace_back();
  thumb.set_name("thumb");
  thumb.set_first_hip(0);
  thumb.set_hips(2);
  auto& index = names.fingers.emplace_back();
  index.set_name("index");
  index.set_first_hip(2);
  index.set_hips(1);
  return names;
}

void add_contact(v1::HipsFrame& hips, std::uint32_t hip, v1::ConstraintState state, bool slipping,
                 double force) {
  hips.add_contact_hip(hip);
  hips.add_contact_object(0);
  hips.add_contact_state(state);
  hips.add_contact_slipping(slipping);
  for (const double component : {0.0, 0.0, force}) {
    hips.add_contact_force(component);
    hips.add_contact_proxy(component);
  }
}

v1::HipsFrame three_hips() {
  v1::HipsFrame hips;
  for (int hip = 0; hip < 3; ++hip) {
    for (const double component : {0.0, 0.0, 1.0 + hip}) {
      hips.add_position(0.0);
      hips.add_force(component);
    }
  }
  return hips;
}

TEST(SummariseFingers, SumsTheForcesOfEachFingersHips) {
  const auto fingers = summarise_fingers(example_names(), three_hips());
  ASSERT_EQ(fingers.size(), 2U);
  EXPECT_EQ(fingers[0].force[2], 3.0);  // 1 + 2
  EXPECT_EQ(fingers[1].force[2], 3.0);
}

TEST(SummariseFingers, CountsAHipOnceHoweverManyObjectsHoldIt) {
  v1::HipsFrame hips = three_hips();
  add_contact(hips, 0, v1::SUR, false, 1.0);
  add_contact(hips, 0, v1::EDG, true, 1.0);
  const auto fingers = summarise_fingers(example_names(), hips);
  EXPECT_EQ(fingers[0].contacts, 1U);
  EXPECT_EQ(fingers[0].slipping, 1U);
  EXPECT_EQ(fingers[1].contacts, 0U);
}

TEST(SummariseFingers, DoesNotCountAHipThatIsFreeInACell) {
  v1::HipsFrame hips = three_hips();
  add_contact(hips, 0, v1::TET, false, 0.0);
  add_contact(hips, 1, v1::TET, false, 0.5);  // viscous: the cell resists
  EXPECT_EQ(summarise_fingers(example_names(), hips)[0].contacts, 1U);
}

TEST(Tables, SurviveFramesWithMissingNumbers) {
  v1::HipsFrame hips = three_hips();
  hips.add_contact_state(v1::SUR);
  hips.add_contact_hip(4'000'000'000);
  EXPECT_NE(hips_table(example_names(), hips), "");
  EXPECT_NE(fingers_table(example_names(), hips), "");
  v1::ObjectsFrame objects;
  for (const double component : {1.0, 2.0, 3.0, 4.0, 5.0, 6.0}) {
    objects.add_position(component);
  }
  EXPECT_NE(objects_table(example_names(), objects).find("#1"), std::string::npos);
  v1::DevicesFrame devices;
  devices.add_present(true);
  EXPECT_NE(devices_table(example_names(), devices), "");
}

TEST(Tables, OfNothingAreEmpty) {
  EXPECT_EQ(objects_table({}, {}), "");
  EXPECT_EQ(devices_table({}, {}), "");
  EXPECT_EQ(fingers_table({}, {}), "");
  EXPECT_EQ(hips_table({}, {}), "");
}

}  // namespace
}  // namespace haptic::cli
