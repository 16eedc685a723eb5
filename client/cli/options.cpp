#include "client/cli/options.h"

#include <CLI/CLI.hpp>
#include <cmath>

namespace haptic::cli {
namespace {

// CLI11's ranges let nan in
CLI::Validator a_number() {
  return {[](const std::string& text) {
            double value = 0.0;
            return CLI::detail::lexical_cast(text, value) && std::isnan(value) ? text + " is not a number"
                                                                               : std::string();
          },
          ""};
}

}  // namespace

Option Option::required() const {
  made_->required();
  return *this;
}

Option Option::type(const std::string& name) const {
  made_->type_name(name);
  return *this;
}

Option Option::values(int count) const {
  made_->expected(count);
  return *this;
}

Option Option::separated_by(char separator) const {
  made_->delimiter(separator);
  return *this;
}

Option Option::repeatable() const {
  made_->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  return *this;
}

Option Option::show_default() const {
  made_->capture_default_str();
  return *this;
}

Option Option::positive() const {
  made_->check(CLI::PositiveNumber)->check(a_number());
  return *this;
}

Option Option::between(double least, double most) const {
  made_->check(CLI::Range(least, most).description(""))->check(a_number());
  return *this;
}

Option Option::between(std::uint32_t least, std::uint32_t most, Told told) const {
  CLI::Validator range = CLI::Range(least, most);
  if (told == Told::kNo) {
    range.description("");
  }
  made_->check(range);
  return *this;
}

Option Option::one_of(const std::vector<std::string>& words) const {
  made_->check(CLI::IsMember(words).description(""));
  return *this;
}

Option Option::check(std::function<std::string(const std::string&)> problem) const {
  made_->check(CLI::Validator(std::move(problem), ""));
  return *this;
}

Option Option::transform(std::function<std::string(std::string&)> change) const {
  made_->transform(CLI::Validator(std::move(change), ""));
  return *this;
}

Option Option::needs(Option other) const {
  made_->needs(other.made_);
  return *this;
}

Option Option::excludes(Option other) const {
  made_->excludes(other.made_);
  return *this;
}

Option add_option(CLI::App& verb, const std::string& name, std::string& into, const std::string& help) {
  return Option(verb.add_option(name, into, help));
}

Option add_option(CLI::App& verb, const std::string& name, double& into, const std::string& help) {
  return Option(verb.add_option(name, into, help));
}

Option add_option(CLI::App& verb, const std::string& name, std::int32_t& into, const std::string& help) {
  return Option(verb.add_option(name, into, help));
}

Option add_option(CLI::App& verb, const std::string& name, std::uint32_t& into, const std::string& help) {
  return Option(verb.add_option(name, into, help));
}

Option add_option(CLI::App& verb, const std::string& name, std::uint64_t& into, const std::string& help) {
  return Option(verb.add_option(name, into, help));
}

Option add_option(CLI::App& verb, const std::string& name, std::optional<double>& into,
                  const std::string& help) {
  return Option(verb.add_option(name, into, help));
}

Option add_option(CLI::App& verb, const std::string& name, std::vector<std::string>& into,
                  const std::string& help) {
  return Option(verb.add_option(name, into, help));
}

Option add_option(CLI::App& verb, const std::string& name, std::vector<double>& into,
                  const std::string& help) {
  return Option(verb.add_option(name, into, help));
}

Option add_option(CLI::App& verb, const std::string& name, std::vector<std::uint32_t>& into,
                  const std::string& help) {
  return Option(verb.add_option(name, into, help));
}

Option add_text(CLI::App& verb, const std::string& name, const std::string& help,
                const std::function<void(const std::string&)>& take) {
  return Option(verb.add_option_function<std::string>(name, take, help));
}

Option add_number(CLI::App& verb, const std::string& name, const std::string& help,
                  const std::function<void(double)>& take) {
  return Option(verb.add_option_function<double>(
      name, [take](const double& number) { take(number); }, help));
}

Option add_count(CLI::App& verb, const std::string& name, const std::string& help,
                 const std::function<void(std::uint32_t)>& take) {
  return Option(verb.add_option_function<std::uint32_t>(
      name, [take](const std::uint32_t& count) { take(count); }, help));
}

Option add_numbers(CLI::App& verb, const std::string& name, const std::string& help,
                   const std::function<void(const std::vector<double>&)>& take) {
  return Option(verb.add_option_function<std::vector<double>>(name, take, help));
}

Option add_flag(CLI::App& verb, const std::string& name, bool& into, const std::string& help) {
  return Option(verb.add_flag(name, into, help));
}

Option add_flag(CLI::App& verb, const std::string& name, const std::string& help,
                std::function<void()> take) {
  return Option(verb.add_flag_callback(name, std::move(take), help));
}

Option add_choice(CLI::App& verb, const std::string& name, const std::string& help,
                  const std::map<std::string, int>& words, const std::function<void(int)>& take) {
  return Option(verb.add_option_function<int>(
                        name, [take](const int& value) { take(value); }, help)
                    ->transform(CLI::CheckedTransformer(words, CLI::ignore_case).description("")));
}

Option add_choices(CLI::App& verb, const std::string& name, const std::string& help,
                   const std::map<std::string, int>& words,
                   const std::function<void(const std::vector<int>&)>& take) {
  return Option(verb.add_option_function<std::vector<int>>(name, take, help)
                    ->transform(CLI::CheckedTransformer(words, CLI::ignore_case).description("")));
}

Option find_option(CLI::App& verb, const std::string& name) { return Option(verb.get_option(name)); }

void set_footer(CLI::App& verb, const std::string& text) { verb.footer(text); }

void hide(CLI::App& verb) { verb.group(""); }

void when_read(CLI::App& verb, std::function<void()> judge) {
  verb.parse_complete_callback(std::move(judge));
}

void refuse_without(const std::string& name) { throw CLI::RequiredError(name); }

void refuse(const std::string& option, const std::string& why) { throw CLI::ValidationError(option, why); }

bool read_number(const std::string& text, double& number) { return CLI::detail::lexical_cast(text, number); }

}  // namespace haptic::cli
