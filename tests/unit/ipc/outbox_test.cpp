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
  proto::append_varint(size - 2 - proto::varint_size(size - 3), bytes);
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

constexpr TopicSet kHips = topic_bit(v1::HIPS);

OutgoingFrame frame_of(std::uint32_t subscription, std::uint64_t sequence, std::size_t size,
                       v1::Delivery delivery = v1::DELIVERY_UNSPECIFIED) {
  // so that ticks and sequences are not the same: frame n is of tick 10 n
  return {.subscription = subscription,
          .sequence = sequence,
          .delivery = delivery,
          .topics = kHips,
          .tick = 10 * sequence,
          .lost_before = {},
          .body = body_of(size)};
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
    outbox.push_frame(frame_of(5, sequence, 20));
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
  outbox.push_frame(frame_of(1, 1, 20));
  EXPECT_EQ(read_all(outbox).size(), 1U);
  for (std::uint64_t sequence = 2; sequence <= 6; ++sequence) {
    outbox.push_frame(frame_of(1, sequence, 20));
  }
  const auto read = read_all(outbox);
  ASSERT_EQ(read.size(), 3U);
  EXPECT_EQ(read[0].gap().first_sequence(), 2U);
  EXPECT_EQ(read[0].gap().last_sequence(), 4U);
}

TEST(Outbox, TellsOfFramesThatWereLostBeforeTheyCame) {
  Outbox outbox({});
  outbox.push_frame(frame_of(1, 1, 20));
  OutgoingFrame late = frame_of(1, 5, 20);
  late.lost_before = {topic_bit(v1::OBJECTS), 11, 49};
  outbox.push_frame(late);
  const auto read = read_all(outbox);
  ASSERT_EQ(read.size(), 3U);
  EXPECT_EQ(read[1].gap().first_sequence(), 2U);
  EXPECT_EQ(read[1].gap().last_sequence(), 4U);
}

TEST(Outbox, NamesTopicsAndTicksOfWhatWasLostWhereverItWasLost) {
  Outbox outbox({.control_bytes = 1000, .data_bytes = 100000, .data_frames = 1});
  outbox.push_frame(frame_of(1, 1, 20));
  OutgoingFrame event = frame_of(1, 2, 20);
  event.topics = topic_bit(v1::EVENTS);
  outbox.push_frame(event);  // 1 is dropped
  OutgoingFrame late = frame_of(1, 6, 20);
  late.lost_before = {topic_bit(v1::OBJECTS), 31, 59};
  outbox.push_frame(late);  // 2 is dropped, 3 to 5 never came here
  const auto read = read_all(outbox);
  ASSERT_EQ(read.size(), 2U);
  const v1::Gap& gap = read[0].gap();
  EXPECT_EQ(gap.first_sequence(), 1U);
  EXPECT_EQ(gap.last_sequence(), 5U);
  EXPECT_EQ(gap.first_tick(), 10U);
  EXPECT_EQ(gap.last_tick(), 59U);
  ASSERT_EQ(gap.topic_size(), 3);
  EXPECT_EQ(gap.topic(0), v1::OBJECTS);
  EXPECT_EQ(gap.topic(1), v1::HIPS);
  EXPECT_EQ(gap.topic(2), v1::EVENTS);
}

TEST(Outbox, KeepsALossBetweenFramesThatWaitWhereItWas) {
  Outbox outbox({});
  outbox.push_frame(frame_of(1, 1, 20, v1::LOSSLESS));
  outbox.push_frame(frame_of(1, 2, 20, v1::LOSSLESS));
  OutgoingFrame late = frame_of(1, 4, 20, v1::LOSSLESS);
  late.lost_before = {kHips, 21, 39};
  outbox.push_frame(late);
  const auto read = read_all(outbox);
  ASSERT_EQ(read.size(), 3U);
  EXPECT_EQ(read[0].batch().frame_size(), 2);
  EXPECT_EQ(read[1].gap().first_tick(), 21U);
  EXPECT_EQ(read[2].frame().sequence(), 4U);
}

TEST(Outbox, KeepsOnlyTheNewestOfLatest) {
  Outbox outbox({});
  outbox.push_frame(frame_of(2, 1, 20));
  for (std::uint64_t sequence = 1; sequence <= 5; ++sequence) {
    outbox.push_frame(frame_of(1, sequence, 20, v1::LATEST));
  }
  const auto read = read_all(outbox);
  ASSERT_EQ(read.size(), 3U);
  EXPECT_EQ(read[0].frame().subscription(), 2U);  // another subscription loses nothing by it
  EXPECT_EQ(read[1].gap().last_sequence(), 4U);
  EXPECT_EQ(read[2].frame().sequence(), 5U);
}

TEST(Outbox, BatchesLosslessFramesThatWaitTogetherUpToABound) {
  Outbox outbox({});
  for (std::uint64_t sequence = 1; sequence <= 130; ++sequence) {
    outbox.push_frame(frame_of(1, sequence, 20, v1::LOSSLESS));
  }
  const auto read = read_all(outbox);
  // 64 + 64 + 2
  ASSERT_EQ(read.size(), 3U);
  ASSERT_EQ(read[0].batch().frame_size(), 64);
  ASSERT_EQ(read[2].batch().frame_size(), 2);
  EXPECT_EQ(read[0].batch().frame(0).subscription(), 1U);
  EXPECT_EQ(read[2].batch().frame(1).sequence(), 130U);
}

TEST(Outbox, BoundsTheBytesOfABatch) {
  Outbox outbox({});
  for (std::uint64_t sequence = 1; sequence <= 4; ++sequence) {
    outbox.push_frame(frame_of(1, sequence, 30'000, v1::LOSSLESS));
  }
  const auto read = read_all(outbox);
  // two of 30 000 bytes are within 65 536, three are not
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0].batch().frame_size(), 2);
}

TEST(Outbox, SendsALosslessFrameThatIsAloneWithoutABatch) {
  Outbox outbox({});
  outbox.push_frame(frame_of(1, 1, 20, v1::LOSSLESS));
  const auto read = read_all(outbox);
  ASSERT_EQ(read.size(), 1U);
  EXPECT_TRUE(read[0].has_frame());
}

TEST(Outbox, KeepsGapsOfSubscriptionsApart) {
  Outbox outbox({.control_bytes = 1000, .data_bytes = 100000, .data_frames = 2});
  for (std::uint64_t sequence = 1; sequence <= 3; ++sequence) {
    outbox.push_frame(frame_of(1, sequence, 20));
    outbox.push_frame(frame_of(2, sequence, 20));
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
    outbox.push_frame(frame_of(1, sequence, 300));
  }
  // 3 bodies of 300 bytes fit in 1000
  const auto read = read_all(outbox);
  ASSERT_EQ(read.size(), 4U);
  EXPECT_EQ(read[0].gap().last_sequence(), 7U);
}

TEST(Outbox, KeepsOneFrameThatIsLargerThanTheBound) {
  Outbox outbox({.control_bytes = 1000, .data_bytes = 1000, .data_frames = 100});
  outbox.push_frame(frame_of(1, 1, 5000));
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
  outbox.push_frame(frame_of(1, 1, 20));
  outbox.push_control(control_message(7));
  const auto read = read_all(outbox);
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0].response().id(), 7U);
  EXPECT_TRUE(read[1].has_frame());
}

TEST(Outbox, SendsNothingMoreOfAForgottenSubscription) {
  Outbox outbox({});
  outbox.push_frame(frame_of(1, 1, 20));
  outbox.push_frame(frame_of(2, 1, 20));
  outbox.forget(1);
  const auto read = read_all(outbox);
  ASSERT_EQ(read.size(), 1U);
  EXPECT_EQ(read[0].frame().subscription(), 2U);
}

}  // namespace
}  // namespace haptic::ipc
