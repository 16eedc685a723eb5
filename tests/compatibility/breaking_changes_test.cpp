// That the comparison sees what it is for: a schema of a few lines, changed in each way that breaks.

#include "tests/compatibility/breaking_changes.h"

#include <google/protobuf/compiler/parser.h>
#include <google/protobuf/descriptor.pb.h>
#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <gtest/gtest.h>

namespace haptic::test {
namespace {

namespace pb = google::protobuf;

constexpr const char* kSchema = R"(
  syntax = "proto3"; package p;
  message Call {
    oneof call { Ask ask = 1; Tell tell = 2; }
    repeated double values = 3;
    uint32 count = 4;
    message Inner { string name = 1; }
    enum Kind { NONE = 0; ONE = 1; }
  }
  message Ask {}
  message Tell {}
  enum Colour { BLACK = 0; RED = 1; }
)";

const pb::FileDescriptor* parse(const std::string& text, pb::DescriptorPool& pool) {
  pb::io::ArrayInputStream stream(text.data(), static_cast<int>(text.size()));
  pb::io::Tokenizer tokenizer(&stream, nullptr);
  pb::FileDescriptorProto file;
  EXPECT_TRUE(pb::compiler::Parser().Parse(&tokenizer, &file)) << text;
  file.set_name("p.proto");
  const pb::FileDescriptor* const built = pool.BuildFile(file);
  EXPECT_NE(built, nullptr) << text;
  return built;
}

// what is found when `from` becomes `to` in the schema
std::vector<std::string> changes(const std::string& from, const std::string& to) {
  pb::DescriptorPool before;
  pb::DescriptorPool after;
  std::string text = kSchema;
  text.replace(text.find(from), from.size(), to);
  parse(text, after);
  return breaking_changes(*parse(kSchema, before), after);
}

using Lines = std::vector<std::string>;

TEST(BreakingChanges, AreNotAdditions) {
  EXPECT_EQ(changes("uint32 count = 4;", "uint32 count = 4; string more = 5;"), Lines{});
  EXPECT_EQ(changes("Tell tell = 2;", "Tell tell = 2; Inner third = 6;"), Lines{});
  EXPECT_EQ(changes("RED = 1;", "RED = 1; GREEN = 2;"), Lines{});
  EXPECT_EQ(changes("message Tell {}", "message Tell { bool loud = 1; } message New {}"), Lines{});
}

TEST(BreakingChanges, AreRemovals) {
  EXPECT_EQ(changes("uint32 count = 4;", ""), Lines{"field p.Call.count = 4 is gone"});
  EXPECT_EQ(changes("uint32 count = 4;", "reserved 4;"), Lines{"field p.Call.count = 4 is gone"});
  EXPECT_EQ(changes("RED = 1;", ""), Lines{"value p.RED is gone"});
  EXPECT_EQ(changes("ONE = 1;", ""), Lines{"value p.Call.ONE is gone"});
  EXPECT_EQ(changes("message Inner { string name = 1; }", ""), Lines{"message p.Call.Inner is gone"});
  EXPECT_EQ(changes("enum Colour", "enum Color"), Lines{"enum p.Colour is gone"});
}

TEST(BreakingChanges, AreOtherNumbersNamesTypesAndLabels) {
  EXPECT_EQ(changes("count = 4", "count = 5"), Lines{"field p.Call.count = 4 is gone"});
  EXPECT_EQ(changes("RED = 1", "RED = 2"), Lines{"value p.RED was 1, is 2"});
  EXPECT_EQ(changes("count = 4", "number = 4"), Lines{"field p.Call.count is now called number"});
  EXPECT_EQ(changes("uint32 count", "uint64 count"), Lines{"field p.Call.count was uint32, is uint64"});
  EXPECT_EQ(changes("uint32 count", "repeated uint32 count").size(), 1U);
  EXPECT_EQ(changes("uint32 count", "optional uint32 count").size(), 1U);
  EXPECT_EQ(changes("Tell tell = 2", "Ask tell = 2"),
            Lines{"field p.Call.tell was p.Tell in call, is p.Ask in call"});
}

TEST(BreakingChanges, AreFieldsMovedOutOfTheirOneof) {
  EXPECT_EQ(changes("Tell tell = 2; }", "} Tell tell = 2;"),
            Lines{"field p.Call.tell was p.Tell in call, is p.Tell"});
}

TEST(BreakingChanges, AreArraysThatAreNoLongerPacked) {
  EXPECT_EQ(changes("values = 3", "values = 3 [packed = false]").size(), 1U);
}

}  // namespace
}  // namespace haptic::test
