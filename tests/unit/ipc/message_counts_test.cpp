#include "ipc/message_counts.h"

#include <gtest/gtest.h>

namespace haptic::ipc {
namespace {

TEST(MessageCounts, NamesTheListThatIsTooLong) {
  v1::Request request;
  v1::Scene& scene = *request.mutable_load_scene()->mutable_scene();
  scene.add_finger();
  v1::Finger& finger = *scene.add_finger();
  for (int i = 0; i < 5; ++i) {
    finger.mutable_points()->add_hip();
  }
  EXPECT_FALSE(check_counts(request, 5));
  const auto error = check_counts(request, 4);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), v1::Error::INVALID);
  EXPECT_EQ(error->field(), "load_scene.scene.finger[1].points.hip");
  EXPECT_EQ(error->message(), "load_scene.scene.finger[1].points.hip has 5 items; 4 are permitted");
}

TEST(MessageCounts, CountsEditsAndTopics) {
  v1::Request edits;
  v1::Request topics;
  for (int i = 0; i < 3; ++i) {
    edits.mutable_edit_scene()->add_edit();
    topics.mutable_subscribe()->add_topic(v1::HIPS);
  }
  EXPECT_EQ(check_counts(edits, 2)->field(), "edit_scene.edit");
  EXPECT_EQ(check_counts(topics, 2)->field(), "subscribe.topic");
  EXPECT_FALSE(check_counts(edits, 3));
  EXPECT_FALSE(check_counts(topics, 3));
}

}  // namespace
}  // namespace haptic::ipc
