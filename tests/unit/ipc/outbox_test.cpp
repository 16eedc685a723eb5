#include "ipc/outbox.h"

#include <gtest/gtest.h>

#include "haptic/v1/control.pb.h"
#include "proto/framing.h"
#include "proto/protocol.h"

namespace haptic::ipc {
namespace {

SharedBytes body_of(std::size_t size) {
  // a field that the schema does not know, so that the body can have any size above 3 bytes
  std::string bytes = "\xaa\x06";
  proto::append_varint(size - 3, bytes);
  bytes.resize(size, 'x');
  return std::make_shared<const std::string>(bytes);
}

std::string control_message(std::uint64_t id) {
  v1::Envelope envelope;
  envelope.mutable_response()->set_id(id);
  std::string bytes;
  proto::append_frame(envelope, bytes);
  return bytes;
}

// what the client reads when it takes everything
std::vector<v1::Envelope> read_all(Outbox& outbox) {
  proto::FrameReader reader(proto::kReplyLimit);
  std::vector<v1::Envelope> envelopes;
  while (true) {
    const std::vector<Piece> pieces = outbox.take(100);
    if (pieces.empty()) {
      return envelopes;
    }
    for (const Piece& piece : pieces) {
      reader.append(piece.own + (piece.shared ? *piece.shared : ""));
      while (const auto message = reader.next()) {
        envelopes.emplace_back().ParseFromString(std::string(*message));
      }
    }
  }
}

TEST(Outbox, DropsTheOldestFramesAndTellsExactlyWhich) {
  Outbox outbox({.control_bytes = 1000, .data_bytes = 100000, .data_frames = 3});
  for (std::uint64_t sequence = 1; sequence <= 10; ++sequence) {
    outbox.push_frame(5, sequence, body_of(20));
  }
  const auto read = read_all(outbox);
  // 3 of 10 are kept: 8, 9, 10, so 1 to 7 are missing
  ASSERT_EQ(read.size(), 4U);
  EXPECT_EQ(read[0].gap().subscription(), 5U);
  EXPECT_EQ(read[0].gap().first_sequence(), 1U);
  EXPECT_EQ(read[0].gap().last_sequence(), 7U);
  EXPECT_EQ(read[1].frame().sequence(), 8U);
  EXPECT_EQ(read[3].frame().sequence(), 10U);
}

TEST(Outbox, StartsAGapAfterTheLastFrameThatWasSent) {
  Outbox outbox({.control_bytes = 1000, .data_bytes = 100000, .data_frames = 2});
  outbox.push_frame(1, 1, body_of(20));
  EXPECT_EQ(read_all(outbox).size(), 1U);
  for (std::uint64_t sequence = 2; sequence <= 6; ++sequence) {
    outbox.push_frame(1, sequence, body_of(20));
  }
  const auto read = read_all(outbox);
  ASSERT_EQ(read.size(), 3U);
  EXPECT_EQ(read[0].gap().first_sequence(), 2U);
  EXPECT_EQ(read[0].gap().last_sequence(), 4U);
}

TEST(Outbox, TellsOfFramesThatWereLostBeforeTheyCame) {
  Outbox outbox({});
  outbox.push_frame(1, 1, body_of(20));
  outbox.push_frame(1, 5, body_of(20));
  const auto read = read_all(outbox);
  ASSERT_EQ(read.size(), 3U);
  EXPECT_EQ(read[1].gap().first_sequence(), 2U);
  EXPECT_EQ(read[1].gap().last_sequence(), 4U);
}

TEST(Outbox, KeepsGapsOfSubscriptionsApart) {
  Outbox outbox({.control_bytes = 1000, .data_bytes = 100000, .data_frames = 2});
  for (std::uint64_t sequence = 1; sequence <= 3; ++sequence) {
    outbox.push_frame(1, sequence, body_of(20));
    outbox.push_frame(2, sequence, body_of(20));
  }
  const auto read = read_all(outbox);
  ASSERT_EQ(read.size(), 4U);
  EXPECT_EQ(read[0].gap().subscription(), 1U);
  EXPECT_EQ(read[0].gap().last_sequence(), 2U);
  EXPECT_EQ(read[2].gap().subscription(), 2U);
  EXPECT_EQ(read[2].gap().last_sequence(), 2U);
}

TEST(Outbox, BoundsBytesAsWellAsFrames) {
  Outbox outbox({.control_bytes = 1000, .data_bytes = 1000, .data_frames = 100});
  for (std::uint64_t sequence = 1; sequence <= 10; ++sequence) {
    outbox.push_frame(1, sequence, body_of(300));
  }
  // 3 bodies of 300 bytes fit in 1000
  const auto read = read_all(outbox);
  ASSERT_EQ(read.size(), 4U);
  EXPECT_EQ(read[0].gap().last_sequence(), 7U);
}

TEST(Outbox, KeepsOneFrameThatIsLargerThanTheBound) {
  Outbox outbox({.control_bytes = 1000, .data_bytes = 1000, .data_frames = 100});
  outbox.push_frame(1, 1, body_of(5000));
  EXPECT_EQ(read_all(outbox).size(), 1U);
}

TEST(Outbox, RefusesControlThatOverflowsAndKeepsWhatItHas) {
  const std::string message = control_message(1);
  Outbox outbox({.control_bytes = 2 * message.size(), .data_bytes = 1000, .data_frames = 100});
  EXPECT_TRUE(outbox.push_control(message));
  EXPECT_TRUE(outbox.push_control(message));
  EXPECT_FALSE(outbox.push_control(message));
  EXPECT_EQ(read_all(outbox).size(), 2U);
  EXPECT_TRUE(outbox.push_control(message));
}

TEST(Outbox, SendsControlBeforeFrames) {
  Outbox outbox({});
  outbox.push_frame(1, 1, body_of(20));
  outbox.push_control(control_message(7));
  const auto read = read_all(outbox);
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0].response().id(), 7U);
  EXPECT_TRUE(read[1].has_frame());
}

TEST(Outbox, SendsNothingMoreOfAForgottenSubscription) {
  Outbox outbox({});
  outbox.push_frame(1, 1, body_of(20));
  outbox.push_frame(2, 1, body_of(20));
  outbox.forget(1);
  const auto read = read_all(outbox);
  ASSERT_EQ(read.size(), 1U);
  EXPECT_EQ(read[0].frame().subscription(), 2U);
}

}  // namespace
}  // namespace haptic::ipc
