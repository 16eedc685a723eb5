#include "proto/recording/schema_set.h"

#include <google/protobuf/descriptor.pb.h>
#include <google/protobuf/message.h>
#include <gtest/gtest.h>

#include <set>

#include "foxglove/SceneUpdate.pb.h"
#include "haptic/v1/telemetry.pb.h"
#include "proto/recording/error.h"

namespace haptic::recording {
namespace {

google::protobuf::FileDescriptorSet set_of(const Schema& schema) {
  google::protobuf::FileDescriptorSet set;
  EXPECT_TRUE(set.ParseFromString(schema.data));
  return set;
}

TEST(SchemaSet, NamesTheType) {
  const Schema schema = schema_of(*v1::Frame::descriptor(), 7);
  EXPECT_EQ(schema.id, 7);
  EXPECT_EQ(schema.name, "haptic.v1.Frame");
  EXPECT_EQ(schema.encoding, "protobuf");
}

TEST(SchemaSet, HasEachFileOnceAndAfterItsImports) {
  // itself, entity, deletion, eight primitives, six small types, timestamp and duration
  const auto set = set_of(schema_of(*::foxglove::SceneUpdate::descriptor(), 1));
  EXPECT_EQ(set.file_size(), 19);
  std::set<std::string> seen;
  for (const auto& file : set.file()) {
    for (const std::string& import : file.dependency()) {
      EXPECT_TRUE(seen.count(import)) << file.name() << " before " << import;
    }
    EXPECT_TRUE(seen.insert(file.name()).second) << file.name();
  }
  EXPECT_TRUE(seen.count("google/protobuf/timestamp.proto"));
}

TEST(SchemaSet, IsEnoughToReadMessagesWithoutKnowingTheType) {
  v1::Event event;
  event.set_message("armed");
  event.set_tick(5);
  const EmbeddedType type(schema_of(*v1::Event::descriptor(), 1));
  const auto message = type.parse(event.SerializeAsString());
  const auto* const field = message->GetDescriptor()->FindFieldByName("message");
  ASSERT_NE(field, nullptr);
  EXPECT_EQ(message->GetReflection()->GetString(*message, field), "armed");
  EXPECT_THROW(type.parse("\x12\x7f"), FormatError);
}

TEST(SchemaSet, ThatIsBrokenIsRefused) {
  Schema schema = schema_of(*v1::Event::descriptor(), 1);
  Schema other = schema;
  other.encoding = "jsonschema";
  EXPECT_THROW(EmbeddedType{other}, FormatError);
  other = schema;
  other.data = "\xff\xff";
  EXPECT_THROW(EmbeddedType{other}, FormatError);
  other = schema;
  other.name = "haptic.v1.Nothing";
  EXPECT_THROW(EmbeddedType{other}, FormatError);
  // without what it imports
  auto set = set_of(schema);
  set.mutable_file()->DeleteSubrange(0, set.file_size() - 1);
  schema.data = set.SerializeAsString();
  EXPECT_THROW(EmbeddedType{schema}, FormatError);
}

}  // namespace
}  // namespace haptic::recording
