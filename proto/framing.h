#pragma once
// Messages on a byte stream: each is preceded by its length in bytes as a varint (seven bits a byte, least
// significant first, the top bit set on all bytes but the last). Pure; knows neither sockets nor what is in a
// message.
//
//     chunk:  ...bytes]  [05 h e l l o 02 h i 03 a]  [b c ...
//     next():             "hello"      "hi"          "abc"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace google::protobuf {
class MessageLite;
}

namespace haptic::proto {

/// The stream is broken and cannot be read on. what() says why, for a person.
class FramingError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Cuts a stream that arrives in chunks of any size into messages. Holds at most one unfinished message and
/// what the last append() brought: a length beyond the limit is refused before anything is reserved for it.
class FrameReader {
 public:
  /// `limit`: the longest message accepted, in bytes.
  explicit FrameReader(std::size_t limit) noexcept : limit_(limit) {}

  /// From now on. Messages that next() has not yet returned are held to it, too.
  void set_limit(std::size_t limit) noexcept { limit_ = limit; }

  /// Takes the next bytes of the stream. Call next() until it returns nothing before calling this again.
  void append(std::string_view bytes);

  /// The next whole message, or nothing if more bytes are needed. Valid until the next append(). Throws
  /// FramingError on a length that is too large or is not written in the shortest way; what follows cannot be
  /// read, and every later call throws again.
  std::optional<std::string_view> next();

  /// Whether the stream stands between two messages, where it may end.
  bool at_boundary() const noexcept { return read_ == buffer_.size(); }

 private:
  std::size_t limit_;
  std::string buffer_;
  std::size_t read_ = 0;  // bytes of buffer_ that were returned
};

/// Appends `value` as a varint.
void append_varint(std::uint64_t value, std::string& out);

/// How many bytes append_varint() appends.
std::size_t varint_size(std::uint64_t value) noexcept;

/// Appends the message and its length before it.
void append_frame(const google::protobuf::MessageLite& message, std::string& out);

}  // namespace haptic::proto
