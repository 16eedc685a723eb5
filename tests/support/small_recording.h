#pragma once
// A file with two channels, an attachment, metadata and three chunks, small enough to be cut off or broken at
// every byte.

#include <string>
#include <vector>

#include "proto/recording/recording.h"
#include "proto/recording/writer.h"
#include "tests/support/memory_sink.h"

namespace haptic::test {

inline constexpr std::uint64_t kSecond = 1'000'000'000;

/// What a test remembers of a message.
struct Heard {
  std::string topic;
  std::uint64_t log_time = 0;
  std::string data;
  bool operator==(const Heard&) const = default;
};

inline std::vector<Heard> hear(const recording::Recording& recording, recording::Query query = {}) {
  std::vector<Heard> heard;
  for (auto messages = recording.messages(std::move(query)); messages.next();) {
    heard.push_back(
        {messages.channel().topic, messages.message().log_time, std::string(messages.message().data)});
  }
  return heard;
}

/// Two messages a chunk, at 1 s, 2 s, ... 6 s.
inline void write_small(recording::Writer& writer, bool close = true) {
  writer.add(recording::Schema{1, "S", "protobuf", ""});
  writer.add(recording::Channel{1, 1, "/a", "protobuf", {}});
  writer.add(recording::Channel{2, 1, "/b", "protobuf", {}});
  writer.add(recording::Metadata{"who", {{"program", "test"}}});
  for (std::uint64_t i = 1; i <= 6; ++i) {
    const std::string data = "message " + std::to_string(i);
    writer.write({static_cast<std::uint16_t>(1 + i % 2), static_cast<std::uint32_t>(i), i * kSecond,
                  i * kSecond, data});
    if (i % 2 == 0) {
      writer.flush();
    }
    if (i == 4) {
      writer.add(recording::Attachment{4 * kSecond, 0, "mesh", "text/plain", "vertices"});
    }
  }
  if (close) {
    writer.close();
  }
}

/// Chunks are ended by hand only.
inline recording::WriterOptions by_hand() { return {.library = "test", .chunk_ns = std::uint64_t{1} << 62U}; }

inline std::string small_recording() {
  MemorySink sink;
  recording::Writer writer(sink, by_hand());
  write_small(writer);
  return sink.bytes;
}

inline std::vector<Heard> small_messages() {
  std::vector<Heard> heard;
  for (std::uint64_t i = 1; i <= 6; ++i) {
    heard.push_back({i % 2 == 0 ? "/a" : "/b", i * kSecond, "message " + std::to_string(i)});
  }
  return heard;
}

}  // namespace haptic::test
