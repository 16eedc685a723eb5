#include "replay/state_difference.h"

#include <gtest/gtest.h>

#include "tests/support/recording_rig.h"

namespace haptic::replay {
namespace {

class StateDifference : public ::testing::Test {
 protected:
  StateDifference() {
    rig_.tick(400);
    frame_ = std::get<v1::Frame>(rig_.items().back());
  }

  test::RecordingRig rig_;
  v1::Frame frame_;
};

TEST_F(StateDifference, IsNothingBetweenAWorldAndItsOwnFrame) {
  EXPECT_EQ(find_difference(frame_, rig_.world()), "");
}

TEST_F(StateDifference, NamesTheObjectTheQuantityAndBothNumbers) {
  frame_.mutable_objects()->set_position(1, 0.25);
  const std::string found = find_difference(frame_, rig_.world());
  EXPECT_EQ(found.rfind("object box: position.y is ", 0), 0u) << found;
  EXPECT_NE(found.find(", recorded 0.25"), std::string::npos) << found;
}

TEST_F(StateDifference, NamesTheHipByItsFinger) {
  frame_.mutable_hips()->set_force(3 * 5 + 2, 17.0);  // HIPs 0 to 3 are the thumb's
  const std::string found = find_difference(frame_, rig_.world());
  EXPECT_EQ(found.rfind("HIP 1 of finger index: force.z is ", 0), 0u) << found;
}

TEST_F(StateDifference, OfASelectionIsToldByTheNumbersOfTheScene) {
  v1::Frame selected;
  v1::HipsFrame& hips = *selected.mutable_hips();
  hips.add_hip(6);
  for (int axis = 0; axis < 3; ++axis) hips.add_position(frame_.hips().position(3 * 6 + axis));
  EXPECT_EQ(find_difference(selected, rig_.world()), "");
  hips.set_position(0, 3.0);
  EXPECT_EQ(find_difference(selected, rig_.world()).rfind("HIP 2 of finger index: position.x", 0), 0u);
}

}  // namespace
}  // namespace haptic::replay
