#include <fmt/format.h>

#include <algorithm>

#include "client/cli/completion.h"

namespace haptic::cli {
namespace {

constexpr const char* kZshHead = R"shell(#compdef hapticctl
# zsh completion for hapticctl, made by: hapticctl completion zsh
_hapticctl() {
  local word=${words[CURRENT]} verb= before= kind= i
  local -a list socket names
  for ((i = 2; i < CURRENT; ++i)); do
    [[ $before == --socket ]] && socket=(--socket "${words[i]}")
    before=${words[i]}
    case "$verb/$before" in
)shell";

// without the two characters ) and " side by side, which clang-format takes for the string's end
constexpr const char* kZshTail = R"shell(
  case $kind in
    FILE) _files ;;
    OBJECT | FINGER | DEVICE | MATERIAL)
      names=("${(@f)$(${words[1]} __names $kind $socket 2>/dev/null)}")
      [[ -n $names[1] ]] && compadd -a names
      ;;
  esac
  ((${#list})) && _describe hapticctl list
}
if [[ $funcstack[1] == _hapticctl ]]; then
  _hapticctl "$@"
else
  compdef _hapticctl hapticctl
fi
)shell";

constexpr const char* kFishHead = R"shell(# fish completion for hapticctl, made by: hapticctl completion fish
function __hapticctl_verb
  set -l verb ''
  set -l tokens (commandline -opc)
  set -e tokens[1]
  for word in $tokens
    switch "$verb/$word"
)shell";

constexpr const char* kFishMiddle = R"shell(    end
  end
  echo $verb
end
function __hapticctl_at
  test (__hapticctl_verb) = "$argv[1]"
end
function __hapticctl_names
  set -l tokens (commandline -opc)
  set -l socket
  if set -l at (contains -i -- --socket $tokens)
    set socket --socket $tokens[(math $at + 1)]
  end
  $tokens[1] __names $argv[1] $socket 2>/dev/null
end
complete -c hapticctl -f
)shell";

// in single quotes, for zsh
std::string zsh_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  return quoted + "'";
}

// in single quotes, for fish
std::string fish_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    quoted += (c == '\'' || c == '\\' ? "\\" : "") + std::string(1, c);
  }
  return quoted + "'";
}

std::vector<std::string> words_of(const std::string& kind) {
  std::vector<std::string> words;
  std::size_t begin = 0;
  while (kind.find('|') != std::string::npos && begin <= kind.size()) {
    const std::size_t end = std::min(kind.find('|', begin), kind.size());
    words.push_back(kind.substr(begin, end - begin));
    begin = end + 1;
  }
  return words;
}

const std::string& help_of(const std::vector<CompletedVerb>& verbs, const std::string& path) {
  return std::find_if(verbs.begin(), verbs.end(), [&](const auto& verb) { return verb.path == path; })->help;
}

// what zsh offers at this verb: "name:help" of options, or of what may stand without a dash
std::string zsh_list(const std::vector<CompletedVerb>& verbs, const CompletedVerb& verb, bool options) {
  std::string list;
  for (const CompletedOption& option : verb.options) {
    for (const std::string& name : options ? option.names : std::vector<std::string>{}) {
      list += " " + zsh_quoted(name + ":" + option.help);
    }
  }
  if (!options) {
    for (const std::string& below : verb.verbs) {
      list += " " + zsh_quoted(last_word(below) + ":" + help_of(verbs, below));
    }
    for (const std::string& choice : words_of(verb.value)) {
      list += " " + zsh_quoted(choice);
    }
  }
  return list.empty() ? "" : list.substr(1);
}

// how fish completes the value; empty: not at all
std::string fish_value(const std::string& kind) {
  if (has_names(kind)) {
    return fmt::format(" -a '(__hapticctl_names {})'", kind);
  }
  const std::vector<std::string> words = words_of(kind);
  return kind == "FILE" ? " -F" : words.empty() ? "" : fmt::format(" -a '{}'", fmt::join(words, " "));
}

std::string fish_option(const CompletedOption& option) {
  std::string text;
  for (const std::string& name : option.names) {
    text += name.rfind("--", 0) == 0 ? " -l " + name.substr(2) : " -s " + name.substr(1);
  }
  return text + (option.value.empty() ? "" : " -r" + fish_value(option.value)) + " -d " +
         fish_quoted(option.help);
}

}  // namespace

std::string zsh_completion(const std::vector<CompletedVerb>& verbs) {
  std::string text = kZshHead;
  for (const CompletedVerb& verb : verbs) {
    for (const std::string& below : verb.verbs) {
      text += fmt::format("      '{}/{}') verb='{}' ;;\n", verb.path, last_word(below), below);
    }
  }
  text += "    esac\n  done\n  case \"$verb/$before\" in\n";
  for (const CompletedVerb& verb : verbs) {
    for (const CompletedOption& option : verb.options) {
      for (const std::string& name : option.value.empty() ? std::vector<std::string>{} : option.names) {
        text += fmt::format("    '{}/{}') kind='{}' list=({}) ;;\n", verb.path, name, option.value,
                            fmt::join(words_of(option.value), " "));
      }
    }
  }
  text += "    *)\n      case \"$verb/$word\" in\n";
  for (const CompletedVerb& verb : verbs) {
    text += fmt::format("        '{}/-'*) list=({}) ;;\n", verb.path, zsh_list(verbs, verb, true));
    text += fmt::format("        '{}/'*) kind='{}' list=({}){} ;;\n", verb.path, verb.value,
                        zsh_list(verbs, verb, false), after_choice(verb, "list=()"));
  }
  return text + "      esac\n      ;;\n  esac" + kZshTail;
}

std::string fish_completion(const std::vector<CompletedVerb>& verbs) {
  std::string text = kFishHead;
  for (const CompletedVerb& verb : verbs) {
    for (const std::string& below : verb.verbs) {
      text += fmt::format("      case '{}/{}'\n        set verb '{}'\n", verb.path, last_word(below), below);
    }
  }
  text += kFishMiddle;
  for (const CompletedVerb& verb : verbs) {
    const std::string here = fmt::format("complete -c hapticctl -n '__hapticctl_at \"{}\"'", verb.path);
    for (const std::string& below : verb.verbs) {
      text += fmt::format("{} -a {} -d {}\n", here, last_word(below), fish_quoted(help_of(verbs, below)));
    }
    for (const std::string& kind : {verb.value, verb.next_value}) {
      if (const std::string value = fish_value(kind); !value.empty()) {
        text += here + value + "\n";
      }
    }
    for (const CompletedOption& option : verb.options) {
      text += here + fish_option(option) + "\n";
    }
  }
  return text;
}

}  // namespace haptic::cli
