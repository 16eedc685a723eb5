#pragma once
// How verbs say what their arguments are. The parser behind it is CLI11, whose headers take longer to compile
// than any verb: they stay in options.cpp and parser.cpp.

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace haptic::cli {

/// Whether a limit of a value stands in the help.
enum class Told { kNo, kInHelp };

/// An option or an argument that a verb has. It belongs to the parser; this only points at it. Each call says
/// one thing more that holds for it, and returns it again.
class Option {
 public:
  explicit Option(CLI::Option* made) : made_(made) {}

  Option required() const;
  /// What stands for its value in the help, and tells completion of which kind it is: FILE, OBJECT, one|other
  /// ...
  Option type(const std::string& name) const;
  /// It takes as many values, no more and no fewer.
  Option values(int count) const;
  /// Values may also stand in one word, with this between them.
  Option separated_by(char separator) const;
  /// It may be given again and again, and each value counts.
  Option repeatable() const;
  /// The help tells the value that it has now.
  Option show_default() const;

  Option positive() const;  // in the help: POSITIVE
  Option between(double least, double most) const;
  Option between(std::uint32_t least, std::uint32_t most, Told told = Told::kNo) const;
  Option one_of(const std::vector<std::string>& words) const;
  /// `problem` returns what is wrong with a value; empty: nothing.
  Option check(std::function<std::string(const std::string&)> problem) const;
  /// `change` may also replace the value by another.
  Option transform(std::function<std::string(std::string&)> change) const;

  Option needs(Option other) const;
  Option excludes(Option other) const;

 private:
  CLI::Option* made_;
};

/// Each adds an option, whose name begins with - or --, or an argument. Its value goes `into` what must live
/// as long as the parser. A list takes all values up to the next option.
Option add_option(CLI::App& verb, const std::string& name, std::string& into, const std::string& help);
Option add_option(CLI::App& verb, const std::string& name, double& into, const std::string& help);
Option add_option(CLI::App& verb, const std::string& name, std::int32_t& into, const std::string& help);
Option add_option(CLI::App& verb, const std::string& name, std::uint32_t& into, const std::string& help);
Option add_option(CLI::App& verb, const std::string& name, std::uint64_t& into, const std::string& help);
Option add_option(CLI::App& verb, const std::string& name, std::optional<double>& into,
                  const std::string& help);
Option add_option(CLI::App& verb, const std::string& name, std::vector<std::string>& into,
                  const std::string& help);
Option add_option(CLI::App& verb, const std::string& name, std::vector<double>& into,
                  const std::string& help);
Option add_option(CLI::App& verb, const std::string& name, std::vector<std::uint32_t>& into,
                  const std::string& help);

/// As above, but `take` is called with the value when it is read.
Option add_text(CLI::App& verb, const std::string& name, const std::string& help,
                const std::function<void(const std::string&)>& take);
Option add_number(CLI::App& verb, const std::string& name, const std::string& help,
                  const std::function<void(double)>& take);
Option add_count(CLI::App& verb, const std::string& name, const std::string& help,
                 const std::function<void(std::uint32_t)>& take);
Option add_numbers(CLI::App& verb, const std::string& name, const std::string& help,
                   const std::function<void(const std::vector<double>&)>& take);

/// An option without a value: it is there or not.
Option add_flag(CLI::App& verb, const std::string& name, bool& into, const std::string& help);
Option add_flag(CLI::App& verb, const std::string& name, const std::string& help, std::function<void()> take);

/// A value that is one of some words, whose case does not matter; `take` gets the word's number.
Option add_choice(CLI::App& verb, const std::string& name, const std::string& help,
                  const std::map<std::string, int>& words, const std::function<void(int)>& take);
Option add_choices(CLI::App& verb, const std::string& name, const std::string& help,
                   const std::map<std::string, int>& words,
                   const std::function<void(const std::vector<int>&)>& take);

template <typename Enum>
using Words = std::map<std::string, Enum>;

template <typename Enum>
std::map<std::string, int> numbered(const Words<Enum>& words) {
  std::map<std::string, int> numbers;
  for (const auto& [word, value] : words) {
    numbers.emplace(word, static_cast<int>(value));
  }
  return numbers;
}

/// As above, for an enum, an optional one, or a list of them.
template <typename Enum, typename Into>
Option add_choice(CLI::App& verb, const std::string& name, Into& into, const std::string& help,
                  const Words<Enum>& words) {
  return add_choice(verb, name, help, numbered(words),
                    [&into](int value) { into = static_cast<Enum>(value); });
}
template <typename Enum>
Option add_choices(CLI::App& verb, const std::string& name, std::vector<Enum>& into, const std::string& help,
                   const Words<Enum>& words) {
  return add_choices(verb, name, help, numbered(words), [&into](const std::vector<int>& values) {
    into.clear();
    for (const int value : values) {
      into.push_back(static_cast<Enum>(value));
    }
  });
}

/// One that has been added before; it must be there.
Option find_option(CLI::App& verb, const std::string& name);

/// What the help ends with.
void set_footer(CLI::App& verb, const std::string& text);

/// Neither help nor completion tells of the verb.
void hide(CLI::App& verb);

/// Called when all arguments of the verb have been read; it may refuse them.
void when_read(CLI::App& verb, std::function<void()> judge);

/// For what options take, and judges. Each throws what makes of it: "NAME is required", "OPTION: why".
[[noreturn]] void refuse_without(const std::string& name);
[[noreturn]] void refuse(const std::string& option, const std::string& why);

/// Whether the text is a number and nothing else. inf and nan are numbers.
bool read_number(const std::string& text, double& number);

}  // namespace haptic::cli
