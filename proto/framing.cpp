#include "proto/framing.h"

#include <google/protobuf/message_lite.h>

namespace haptic::proto {
namespace {

// 2^35 - 1: more than any limit, and short enough that a broken stream is noticed soon
constexpr std::size_t kLongestVarint = 5;

struct Length {
  std::uint64_t value = 0;
  std::size_t bytes = 0;  // that it is written in; 0: not all of them are there yet
};

Length read_length(std::string_view bytes) {
  Length length;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const auto byte = static_cast<std::uint8_t>(bytes[i]);
    if (i > 0 && byte == 0) {
      throw FramingError("the length of a message is written with more bytes than it needs");
    }
    length.value |= std::uint64_t{byte & 0x7fU} << (7 * i);
    if ((byte & 0x80U) == 0) {
      length.bytes = i + 1;
      return length;
    }
    if (i + 1 == kLongestVarint) {
      throw FramingError("the length of a message is written with more than " +
                         std::to_string(kLongestVarint) + " bytes");
    }
  }
  return length;
}

}  // namespace

void FrameReader::append(std::string_view bytes) {
  buffer_.erase(0, read_);
  read_ = 0;
  buffer_.append(bytes);
}

std::optional<std::string_view> FrameReader::next() {
  const std::string_view rest = std::string_view(buffer_).substr(read_);
  const Length length = read_length(rest);
  if (length.bytes == 0) {
    return std::nullopt;
  }
  if (length.value > limit_) {
    throw FramingError("a message of " + std::to_string(length.value) + " bytes is announced; at most " +
                       std::to_string(limit_) + " are accepted");
  }
  const auto size = static_cast<std::size_t>(length.value);
  if (rest.size() - length.bytes < size) {
    return std::nullopt;
  }
  read_ += length.bytes + size;
  return rest.substr(length.bytes, size);
}

void append_varint(std::uint64_t value, std::string& out) {
  while (value >= 0x80) {
    out.push_back(static_cast<char>(value | 0x80U));
    value >>= 7;
  }
  out.push_back(static_cast<char>(value));
}

std::size_t varint_size(std::uint64_t value) noexcept {
  std::size_t size = 1;
  for (; value >= 0x80; value >>= 7) {
    ++size;
  }
  return size;
}

void append_frame(const google::protobuf::MessageLite& message, std::string& out) {
  append_varint(message.ByteSizeLong(), out);
  message.AppendToString(&out);
}

}  // namespace haptic::proto
