// The mutator of the fuzz targets: what it makes is read again, and in time it tries every field.

#include "tests/fuzz/schema_mutator.h"

#include <google/protobuf/text_format.h>
#include <gtest/gtest.h>

#include <set>

#include "proto/framing.h"
#include "proto/protocol.h"

namespace haptic::fuzz {
namespace {

constexpr std::size_t kRoom = 100'000;

TEST(SchemaMutator, TriesEveryCallOfTheSchema) {
  Random random(1);
  std::set<int> calls;
  for (int i = 0; i < 5000; ++i) {
    v1::Request request;
    mutate(request, random);
    calls.insert(request.call_case());
  }
  const auto* call = v1::Request::descriptor()->FindOneofByName("call");
  EXPECT_EQ(calls.size(), static_cast<std::size_t>(call->field_count()) + 1);  // and none
}

TEST(SchemaMutator, ReachesWhatLiesDeep) {
  Random random(2);
  v1::Scene scene;
  bool reached = false;
  for (int i = 0; i < 20'000 && !reached; ++i) {
    mutate(scene, random);
    for (const v1::Object& object : scene.object()) {
      reached = reached || object.shape().box().size().y() != 0.0;
    }
  }
  EXPECT_TRUE(reached);
}

TEST(SchemaMutator, MakesTextThatIsReadAgain) {
  Random random(3);
  std::vector<std::uint8_t> data(kRoom);
  std::size_t size = 0;
  int changes = 0;
  for (int i = 0; i < 500; ++i) {
    v1::Scene scratch;
    const std::size_t changed = mutate_text(scratch, data.data(), size, kRoom, random);
    changes += changed > 0 ? 1 : 0;
    size = changed;
    v1::Scene scene;
    const std::string text(reinterpret_cast<const char*>(data.data()), size);
    ASSERT_TRUE(google::protobuf::TextFormat::ParseFromString(text, &scene)) << text;
  }
  EXPECT_GT(changes, 400);
}

TEST(SchemaMutator, LeavesTextAloneThatIsNoSuchMessage) {
  Random random(4);
  std::string text = "no { scene";
  v1::Scene scratch;
  EXPECT_EQ(
      mutate_text(scratch, reinterpret_cast<std::uint8_t*>(text.data()), text.size(), text.size(), random),
      0U);
  EXPECT_EQ(text, "no { scene");
}

TEST(SchemaMutator, MakesConversationsThatAreReadAgainAndKeepsTheFirstByte) {
  Random random(5);
  std::vector<std::uint8_t> data(kRoom);
  data[0] = 7;
  std::size_t size = 1;
  std::size_t requests = 0;
  for (int i = 0; i < 500; ++i) {
    const std::size_t changed = mutate_conversation(data.data(), size, kRoom, random);
    if (changed == 0) {
      continue;
    }
    size = changed;
    ASSERT_EQ(data[0], 7);
    proto::FrameReader reader(proto::kRequestLimit);
    reader.append(std::string_view(reinterpret_cast<const char*>(data.data()) + 1, size - 1));
    while (const auto message = reader.next()) {
      v1::Envelope envelope;
      // a string that is no UTF-8 is the only thing that may be refused
      requests += envelope.ParseFromString(std::string(*message)) && envelope.has_request() ? 1U : 0U;
    }
    ASSERT_TRUE(reader.at_boundary());
  }
  EXPECT_GT(requests, 500U);
}

TEST(SchemaMutator, StaysWithinItsRoom) {
  Random random(6);
  std::vector<std::uint8_t> data(50);
  std::size_t size = 1;
  for (int i = 0; i < 500; ++i) {
    const std::size_t changed = mutate_conversation(data.data(), size, data.size(), random);
    ASSERT_LE(changed, data.size());
    size = std::max<std::size_t>(changed, 1);
  }
}

}  // namespace
}  // namespace haptic::fuzz
