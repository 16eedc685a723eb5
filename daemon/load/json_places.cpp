#include "load/json_places.h"

#include <google/protobuf/descriptor.h>

#include <charconv>
#include <set>

#include "load/read_file.h"

namespace haptic::load {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;

constexpr int kDeepest = 64;

bool encloses(std::string_view outer, std::string_view inner) {
  if (!inner.starts_with(outer)) return false;
  return inner.size() == outer.size() || inner[outer.size()] == '.' || inner[outer.size()] == '[';
}

/// One pass over a text: checks it, and remembers the place of the innermost field around a target.
class JsonWalk {
 public:
  JsonWalk(std::string_view text, const std::string& file, std::string_view target)
      : text_(text), target_(target), found_{file, 0, 0, std::string(target)} {}

  Place walk(const Descriptor& type) {
    skip_space();
    if (peek() != '{') fail("expected { at the start");
    object("", &type, 0);
    skip_space();
    if (at_ != text_.size()) fail("expected nothing more after the closing }");
    return found_;
  }

 private:
  [[noreturn]] void fail(const std::string& message, const std::string& field = "") const {
    throw LoadError({found_.file, line_, column(), field}, message);
  }

  std::uint32_t column() const { return static_cast<std::uint32_t>(at_ - line_start_ + 1); }
  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }

  void skip_space() {
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '\n') {
        ++line_;
        line_start_ = at_ + 1;
      } else if (c != ' ' && c != '\t' && c != '\r') {
        return;
      }
    }
  }

  bool take(char c) {
    skip_space();
    if (peek() != c || at_ == text_.size()) return false;
    ++at_;
    return true;
  }

  void value(const std::string& path, const Descriptor* type, int depth) {
    skip_space();
    if (depth > kDeepest)
      fail("is nested too deeply (permitted: " + std::to_string(kDeepest) + " levels)", path);
    switch (peek()) {
      case '{':
        return object(path, type, depth);
      case '[':
        return list(path, type, depth);
      case '"':
        string();
        return;
      case 't':
        return word("true");
      case 'f':
        return word("false");
      case 'n':
        return word("null");
      default:
        return number();
    }
  }

  void object(const std::string& path, const Descriptor* type, int depth) {
    ++at_;
    std::set<std::string> seen;
    if (take('}')) return;
    do {
      skip_space();
      const Place key_place{found_.file, line_, column(), path};
      if (peek() != '"') fail("expected a field name in double quotes", path);
      std::string name = string();
      const FieldDescriptor* field = nullptr;
      if (type != nullptr) {
        field = type->FindFieldByName(name);
        if (field == nullptr) field = type->FindFieldByCamelcaseName(name);
        if (field == nullptr) {
          throw LoadError(key_place, type->full_name() + " has no field named " + in_quotes(name));
        }
        name = field->name();
      }
      const std::string inner = path.empty() ? name : path + "." + name;
      if (!seen.insert(name).second)
        throw LoadError(key_place, "the field " + in_quotes(name) + " is given twice");
      remember(inner, key_place);
      if (!take(':')) fail("expected : after the field name", inner);
      value(inner, field != nullptr ? field->message_type() : nullptr, depth + 1);
    } while (take(','));
    if (!take('}')) fail("expected , or }", path);
  }

  void list(const std::string& path, const Descriptor* type, int depth) {
    ++at_;
    if (take(']')) return;
    std::size_t index = 0;
    do {
      const std::string inner = path + "[" + std::to_string(index++) + "]";
      skip_space();
      if (peek() == 'n') fail("null cannot stand in a list", inner);
      remember(inner, {found_.file, line_, column(), inner});
      value(inner, type, depth + 1);
    } while (take(','));
    if (!take(']')) fail("expected , or ]", path);
  }

  void remember(const std::string& path, const Place& place) {
    if (!encloses(path, target_)) return;
    found_.line = place.line;
    found_.column = place.column;
  }

  std::string string() {
    std::string out;
    ++at_;
    while (peek() != '"' || at_ == text_.size()) {
      if (at_ == text_.size()) fail("the text ends within a string");
      if (static_cast<unsigned char>(peek()) < 0x20) fail("a string cannot hold a control character");
      if (peek() == '\\') {
        out += escape();
      } else {
        out += text_[at_++];
      }
    }
    ++at_;
    return out;
  }

  // what an escape means matters to protobuf's parser only; a name that needs one is no name of ours
  std::string escape() {
    const std::size_t start = at_++;
    const char kind = peek();
    if (kind == 'u') {
      const std::string_view digits = text_.substr(at_ + 1, 4);
      if (digits.size() != 4 ||
          digits.find_first_not_of("0123456789abcdefABCDEF") != std::string_view::npos) {
        fail("expected four hexadecimal digits after \\u");
      }
      at_ += 5;
    } else if (kind != '\0' && std::string_view("\"\\/bfnrt").find(kind) != std::string_view::npos) {
      ++at_;
    } else {
      fail("an escape that JSON does not know");
    }
    return std::string(text_.substr(start, at_ - start));
  }

  void word(std::string_view expected) {
    if (text_.substr(at_, expected.size()) != expected) fail("expected a value");
    at_ += expected.size();
  }

  std::size_t digits() {
    const std::size_t start = at_;
    while (peek() >= '0' && peek() <= '9') ++at_;
    return at_ - start;
  }

  void number() {
    const std::size_t start = at_;
    if (peek() == '-') ++at_;
    const bool leading_zero = peek() == '0';
    const std::size_t whole = digits();
    if (whole == 0) fail("expected a value");
    if (leading_zero && whole > 1) fail("a number cannot start with 0");
    if (peek() == '.') {
      ++at_;
      if (digits() == 0) fail("expected digits after the decimal point");
    }
    if (peek() == 'e' || peek() == 'E') {
      ++at_;
      if (peek() == '+' || peek() == '-') ++at_;
      if (digits() == 0) fail("expected digits in the exponent");
    }
    double parsed = 0.0;
    const auto result = std::from_chars(text_.data() + start, text_.data() + at_, parsed);
    if (result.ec == std::errc::result_out_of_range && text_.find_first_of("eE", start) < at_ &&
        text_.substr(start, at_ - start).find("e-") == std::string_view::npos) {
      fail("the number is too large");
    }
  }

  std::string_view text_;
  std::string_view target_;
  Place found_;
  std::size_t at_ = 0;
  std::uint32_t line_ = 1;
  std::size_t line_start_ = 0;
};

}  // namespace

void check_json(std::string_view text, const std::string& file, const Descriptor& type) {
  JsonWalk(text, file, "").walk(type);
}

Place find_in_json(std::string_view text, const std::string& file, const Descriptor& type,
                   const std::string& field) {
  return JsonWalk(text, file, field).walk(type);
}

}  // namespace haptic::load
