#include "client/cli/script_words.h"

#include <utility>

#include "client/cli/script_parser.h"

namespace haptic::cli {
namespace {

bool is_space(char c) noexcept { return c == ' ' || c == '\t'; }

bool is_name_character(char c) noexcept {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

class Splitter {
 public:
  Splitter(std::string_view text, int line) : text_(text), line_(line) {}

  std::vector<Word> split() {
    while (skip_to_word()) {
      words_.emplace_back();
      while (!at_end() && !is_space(text_[at_])) {
        take_piece();
      }
    }
    return std::move(words_);
  }

 private:
  bool at_end() const noexcept { return at_ == text_.size(); }

  bool skip_to_word() noexcept {
    while (!at_end() && is_space(text_[at_])) {
      ++at_;
    }
    return !at_end() && text_[at_] != '#';
  }

  void take_piece() {
    switch (text_[at_]) {
      case '\'':
        return take_single_quoted();
      case '"':
        return take_double_quoted();
      case '$':
        return take_variable(false);
      case '\\':
        ++at_;
        return take_escaped();
      default:
        literal(text_[at_++]);
    }
  }

  void take_single_quoted() {
    const std::size_t end = text_.find('\'', at_ + 1);
    if (end == std::string_view::npos) {
      throw ScriptError(line_, "a ' is not closed");
    }
    words_.back().push_back({std::string(text_.substr(at_ + 1, end - at_ - 1)), false, true});
    at_ = end + 1;
  }

  void take_double_quoted() {
    ++at_;
    words_.back().push_back({"", false, true});  // "" is a word, too
    while (!at_end() && text_[at_] != '"') {
      if (text_[at_] == '$') {
        take_variable(true);
      } else if (text_[at_] == '\\') {
        ++at_;
        take_escaped();
      } else {
        literal(text_[at_++]);
      }
    }
    if (at_end()) {
      throw ScriptError(line_, "a \" is not closed");
    }
    ++at_;
  }

  void take_escaped() {
    if (at_end()) {
      throw ScriptError(line_, "nothing follows the \\");
    }
    literal(text_[at_++]);
  }

  // $name or ${name}
  void take_variable(bool quoted) {
    ++at_;
    const bool braced = !at_end() && text_[at_] == '{';
    at_ += braced ? 1U : 0U;
    const std::size_t begin = at_;
    while (!at_end() && is_name_character(text_[at_])) {
      ++at_;
    }
    std::string name(text_.substr(begin, at_ - begin));
    if (!is_variable_name(name) || (braced && (at_end() || text_[at_] != '}'))) {
      throw ScriptError(line_, "a $ is followed by no name; \\$ is the character itself");
    }
    at_ += braced ? 1U : 0U;
    words_.back().push_back({std::move(name), true, quoted});
  }

  void literal(char c) {
    Word& word = words_.back();
    if (word.empty() || word.back().variable) {
      word.emplace_back();
    }
    word.back().text += c;
  }

  std::string_view text_;
  int line_;
  std::size_t at_ = 0;
  std::vector<Word> words_;
};

}  // namespace

std::vector<Word> split_words(std::string_view text, int line) { return Splitter(text, line).split(); }

}  // namespace haptic::cli
