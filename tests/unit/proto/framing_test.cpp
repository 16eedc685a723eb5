#include "proto/framing.h"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "haptic/v1/control.pb.h"
#include "proto/protocol.h"

namespace haptic::proto {
namespace {

std::string framed(const std::string& message) {
  std::string out;
  append_varint(message.size(), out);
  return out + message;
}

std::vector<std::string> drain(FrameReader& reader) {
  std::vector<std::string> messages;
  while (const auto message = reader.next()) {
    messages.emplace_back(*message);
  }
  return messages;
}

// 126 to 129: around the step from one byte of length to two; 16384: three bytes
const std::vector<std::string>& some_messages() {
  static const std::vector<std::string> kMessages = {"",
                                                     "a",
                                                     std::string(127, 'b'),
                                                     std::string(128, 'c'),
                                                     std::string("\x80\x80\x00", 3),
                                                     std::string(300, '\xff'),
                                                     ""};
  return kMessages;
}

std::string stream_of(const std::vector<std::string>& messages) {
  std::string stream;
  for (const std::string& message : messages) {
    stream += framed(message);
  }
  return stream;
}

TEST(FrameReader, ReadsTheSameMessagesFromEveryChunkSize) {
  const std::string stream = stream_of(some_messages());
  for (std::size_t chunk = 1; chunk <= stream.size(); ++chunk) {
    FrameReader reader(kGreetingLimit);
    std::vector<std::string> messages;
    for (std::size_t at = 0; at < stream.size(); at += chunk) {
      reader.append(std::string_view(stream).substr(at, chunk));
      for (std::string& message : drain(reader)) {
        messages.push_back(std::move(message));
      }
    }
    ASSERT_EQ(messages, some_messages()) << "in chunks of " << chunk;
    EXPECT_TRUE(reader.at_boundary());
  }
}

TEST(FrameReader, ReadsTheSameMessagesFromEveryCutInTwo) {
  const std::string stream = stream_of(some_messages());
  for (std::size_t cut = 0; cut <= stream.size(); ++cut) {
    FrameReader reader(kGreetingLimit);
    reader.append(std::string_view(stream).substr(0, cut));
    std::vector<std::string> messages = drain(reader);
    reader.append(std::string_view(stream).substr(cut));
    for (std::string& message : drain(reader)) {
      messages.push_back(std::move(message));
    }
    ASSERT_EQ(messages, some_messages()) << "cut at " << cut;
  }
}

TEST(FrameReader, ReadsTheSameMessagesFromRandomChunks) {
  const std::string stream = stream_of(some_messages());
  std::mt19937 random(7);
  for (int round = 0; round < 500; ++round) {
    FrameReader reader(kGreetingLimit);
    std::vector<std::string> messages;
    for (std::size_t at = 0; at < stream.size();) {
      const std::size_t chunk = random() % 40;
      reader.append(std::string_view(stream).substr(at, chunk));
      at += chunk;
      for (std::string& message : drain(reader)) {
        messages.push_back(std::move(message));
      }
    }
    ASSERT_EQ(messages, some_messages());
  }
}

TEST(FrameReader, WaitsForTheRestOfATruncatedMessage) {
  const std::string stream = framed("truncated");
  for (std::size_t size = 0; size < stream.size(); ++size) {
    FrameReader reader(kGreetingLimit);
    reader.append(std::string_view(stream).substr(0, size));
    EXPECT_FALSE(reader.next()) << size;
    EXPECT_EQ(reader.at_boundary(), size == 0);
  }
}

TEST(FrameReader, AcceptsAMessageAsLongAsTheLimitAndRefusesOneByteMore) {
  FrameReader exact(300);
  exact.append(framed(std::string(300, 'x')));
  EXPECT_EQ(exact.next()->size(), 300U);

  FrameReader beyond(300);
  beyond.append(framed(std::string(301, 'x')));
  EXPECT_THROW(beyond.next(), FramingError);
}

TEST(FrameReader, RefusesALyingLengthBeforeItsBytesArrive) {
  FrameReader reader(kGreetingLimit);
  std::string header;
  append_varint(std::uint64_t{1} << 31, header);
  reader.append(header);
  try {
    reader.next();
    FAIL() << "accepted a length of 2 GiB";
  } catch (const FramingError& error) {
    EXPECT_STREQ(error.what(), "a message of 2147483648 bytes is announced; at most 65536 are accepted");
  }
}

TEST(FrameReader, StaysBrokenAfterAnError) {
  FrameReader reader(10);
  reader.append(framed(std::string(11, 'x')));
  EXPECT_THROW(reader.next(), FramingError);
  reader.append(framed("ok"));
  EXPECT_THROW(reader.next(), FramingError);
}

TEST(FrameReader, RefusesOverlongLengths) {
  // 0 as two bytes, 1 as three bytes, and a sixth byte that is never allowed to come
  const std::string overlong[] = {std::string("\x80\x00", 2), std::string("\x81\x80\x00", 3),
                                  std::string("\xff\xff\xff\xff\xff", 5)};
  for (const std::string& bytes : overlong) {
    FrameReader reader(kGreetingLimit);
    reader.append(bytes);
    EXPECT_THROW(reader.next(), FramingError);
  }
}

TEST(FrameReader, HoldsLaterMessagesToANewLimit) {
  FrameReader reader(4);
  reader.append(framed("abcd") + framed("efghi"));
  EXPECT_EQ(reader.next(), "abcd");
  reader.set_limit(5);
  EXPECT_EQ(reader.next(), "efghi");
}

TEST(AppendVarint, MatchesItsSizeAroundEveryStep) {
  for (int bits = 0; bits < 64; ++bits) {
    for (const std::uint64_t value : {(std::uint64_t{1} << bits) - 1, std::uint64_t{1} << bits}) {
      std::string out;
      append_varint(value, out);
      EXPECT_EQ(out.size(), varint_size(value)) << value;
    }
  }
}

TEST(AppendFrame, RoundTripsAnEnvelope) {
  v1::Envelope envelope;
  envelope.mutable_hello()->set_program("test");
  std::string stream = "already there";
  append_frame(envelope, stream);
  FrameReader reader(kGreetingLimit);
  reader.append(stream.substr(13));
  v1::Envelope back;
  ASSERT_TRUE(back.ParseFromString(std::string(*reader.next())));
  EXPECT_EQ(back.hello().program(), "test");
  EXPECT_FALSE(reader.next());
}

}  // namespace
}  // namespace haptic::proto
