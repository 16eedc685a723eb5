#include "client/cli/parser.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>

#include "client/cli/usage.h"

namespace haptic::cli {
namespace {

std::vector<const CLI::App*> shown_verbs(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* verb) { return !verb->get_group().empty(); });
}

std::vector<std::string> names_of(const std::vector<const CLI::App*>& verbs) {
  std::vector<std::string> names;
  names.reserve(verbs.size());
  for (const CLI::App* verb : verbs) {
    names.push_back(verb->get_name());
  }
  return names;
}

const CLI::App& innermost_chosen(const CLI::App& app) {
  const CLI::App* at = &app;
  while (!at->get_subcommands().empty()) {
    at = at->get_subcommands().front();
  }
  return *at;
}

// the parser's own words, unless it is a verb that is not there
std::string in_words(const CLI::ParseError& error, const CLI::App& app) {
  const CLI::App& at = innermost_chosen(app);
  const std::vector<std::string> unread = at.remaining();
  const auto word = std::find_if(unread.begin(), unread.end(),
                                 [](const std::string& each) { return each.rfind('-', 0) != 0; });
  if (at.get_require_subcommand_min() == 0 || word == unread.end()) {
    return error.what();
  }
  const std::string whole = &at == &app ? *word : at.get_name() + " " + *word;
  const std::vector<std::string> near = near_to(*word, names_of(shown_verbs(at)));
  return fmt::format("there is no verb \"{}\"{}", whole,
                     near.empty() ? "" : fmt::format("; did you mean {}?", fmt::join(near, " or ")));
}

void collect(const CLI::App& app, const std::string& path, std::vector<CompletedVerb>& verbs) {
  const std::size_t mine = verbs.size();
  verbs.push_back({path, app.get_description(), {}, {}, "", ""});
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_positional()) {
      if (verbs[mine].value.empty()) {
        verbs[mine].value = option->get_type_name();
      } else if (verbs[mine].next_value.empty() && verbs[mine].value.find('|') != std::string::npos) {
        verbs[mine].next_value = option->get_type_name();
      }
      continue;
    }
    CompletedOption& known = verbs[mine].options.emplace_back();
    for (const std::string& name : option->get_snames()) {
      known.names.push_back("-" + name);
    }
    for (const std::string& name : option->get_lnames()) {
      known.names.push_back("--" + name);
    }
    known.help = option->get_description();
    known.value = option->get_items_expected_max() > 0 ? option->get_type_name() : "";
  }
  for (const CLI::App* verb : shown_verbs(app)) {
    const std::string below = path.empty() ? verb->get_name() : path + " " + verb->get_name();
    verbs[mine].verbs.push_back(below);
    collect(*verb, below, verbs);
  }
}

}  // namespace

void FreeParser::operator()(CLI::App* app) const noexcept { delete app; }

Parser make_parser(const std::string& name, const std::string& help, const std::string& version) {
  Parser app(new CLI::App(help, name));
  app->set_version_flag("--version", version);
  app->require_subcommand(1);
  return app;
}

CLI::App& add_verb(CLI::App& parent, const std::string& name, const std::string& help,
                   std::function<void()> choose) {
  CLI::App* verb = parent.add_subcommand(name, help);
  verb->callback(std::move(choose));
  return *verb;
}

CLI::App& add_family(CLI::App& parent, const std::string& name, const std::string& help) {
  CLI::App* family = parent.add_subcommand(name, help);
  family->require_subcommand(1);
  return *family;
}

CLI::App& add_family(CLI::App& parent, const std::string& name, const std::string& help,
                     std::function<void()> alone) {
  CLI::App& family = add_family(parent, name, help);
  family.require_subcommand(0, 1);
  family.callback([&family, call = std::move(alone)] {
    if (family.get_subcommands().empty()) call();
  });
  return family;
}

std::optional<std::string> parse(CLI::App& app, const std::vector<std::string>& words) {
  // CLI11 takes the words from the end
  std::vector<std::string> reversed(words.rbegin(), words.rend());
  try {
    app.parse(reversed);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) {
      throw UsageError(in_words(error, app));
    }
    std::ostringstream text;
    app.exit(error, text, text);
    return text.str();
  }
  return std::nullopt;
}

std::string chosen_verb(const CLI::App& app) {
  std::string path;
  for (const CLI::App* at = &app; !at->get_subcommands().empty();) {
    at = at->get_subcommands().front();
    path += (path.empty() ? "" : " ") + at->get_name();
  }
  return path;
}

std::vector<CompletedVerb> completed_verbs(const CLI::App& app) {
  std::vector<CompletedVerb> verbs;
  collect(app, "", verbs);
  return verbs;
}

}  // namespace haptic::cli
