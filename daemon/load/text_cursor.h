#pragma once
// Numbers out of a large text, line by line, without copies: what the readers of mesh files share.

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "load/error.h"
#include "load/read_file.h"

namespace haptic::load {

class TextCursor {
 public:
  TextCursor(std::string_view text, std::string file)
      : at_(text.data()), end_(at_ + text.size()), line_start_(at_), file_(std::move(file)) {}

  [[noreturn]] void fail(const std::string& message) const {
    throw LoadError({file_, line_, static_cast<std::uint32_t>(at_ - line_start_ + 1), ""}, message);
  }

  std::uint32_t line() const noexcept { return line_; }
  std::size_t remaining() const noexcept { return static_cast<std::size_t>(end_ - at_); }
  const char* position() const noexcept { return at_; }

  /// Goes to the next line that holds anything; '#' starts a comment. False at the end of the text.
  bool next_line() noexcept {
    for (;;) {
      skip_blanks();
      if (at_ == end_) return false;
      if (*at_ == '#') {
        while (at_ != end_ && *at_ != '\n') ++at_;
      } else if (*at_ == '\n') {
        end_line();
      } else {
        return true;
      }
    }
  }

  /// The line must end here, but for blanks and a comment. `what` names what the line was, for the error.
  void expect_end_of_line(const char* what) {
    skip_blanks();
    if (at_ == end_ || *at_ == '#') return;
    if (*at_ != '\n') fail(std::string("has more fields than ") + what);
  }

  bool at_end_of_line() noexcept {
    skip_blanks();
    return at_ == end_ || *at_ == '\n' || *at_ == '#';
  }

  /// The next number of this line. `what` names it, for the error.
  template <class Number>
  Number number(const char* what) {
    if (at_end_of_line()) fail(std::string("the line ends where ") + what + " should stand");
    Number value{};
    const auto result = std::from_chars(at_, end_, value);
    const bool ends = result.ptr == end_ || *result.ptr == ' ' || *result.ptr == '\n' ||
                      *result.ptr == '\t' || *result.ptr == '\r' || *result.ptr == '#';
    bool good = result.ec == std::errc{} && ends;
    if constexpr (std::is_floating_point_v<Number>) good = good && std::isfinite(value);
    if (!good) fail(std::string("expected ") + what + ", found " + in_quotes(word()));
    at_ = result.ptr;
    return value;
  }

  /// The rest of this word, without moving.
  std::string_view word() const noexcept {
    const char* end = at_;
    while (end != end_ && *end != ' ' && *end != '\n' && *end != '\t' && *end != '\r') ++end;
    return {at_, static_cast<std::size_t>(end - at_)};
  }

  /// To the end of this line.
  void skip_line() noexcept {
    while (at_ != end_ && *at_ != '\n') ++at_;
  }

  /// Moves on by so many bytes, line ends included.
  void advance(std::size_t bytes) noexcept {
    for (const char* const target = at_ + bytes; at_ != target;) {
      if (*at_ == '\n') {
        end_line();
      } else {
        ++at_;
      }
    }
  }

 private:
  void skip_blanks() noexcept {
    while (at_ != end_ && (*at_ == ' ' || *at_ == '\t' || *at_ == '\r')) ++at_;
  }
  void end_line() noexcept {
    ++at_;
    ++line_;
    line_start_ = at_;
  }

  const char* at_;
  const char* end_;
  const char* line_start_;
  std::string file_;
  std::uint32_t line_ = 1;
};

}  // namespace haptic::load
