#include "client/cli/completion.h"

#include <fmt/format.h>

#include <algorithm>

namespace haptic::cli {
namespace {

constexpr const char* kBashHead = R"shell(# bash completion for hapticctl, made by: hapticctl completion bash
_hapticctl() {
  local word=${COMP_WORDS[COMP_CWORD]} verb= before= kind= list= item i
  local -a socket=()
  COMPREPLY=()
  for ((i = 1; i < COMP_CWORD; ++i)); do
    [[ $before == --socket ]] && socket=(--socket "${COMP_WORDS[i]}")
    before=${COMP_WORDS[i]}
    case "$verb/$before" in
)shell";

// names are compared and quoted here: compgen -W would run what stands in them
constexpr const char* kBashTail = R"shell(
  list=${list// /$'\n'}
  case $kind in
    FILE)
      compopt -o filenames 2>/dev/null
      mapfile -t COMPREPLY < <(compgen -f -- "$word")
      return
      ;;
    OBJECT | FINGER | DEVICE | MATERIAL)
      list+=$'\n'$("${COMP_WORDS[0]}" __names "$kind" "${socket[@]}" 2>/dev/null)
      ;;
  esac
  while IFS= read -r item; do
    [[ -n $item && $item == "$word"* ]] && COMPREPLY+=("$(printf %q "$item")")
  done <<<"$list"
}
complete -F _hapticctl hapticctl
)shell";

// words to choose from, separated by spaces; empty for kinds that are none
std::string choices(const std::string& kind) {
  std::string words = kind.find('|') == std::string::npos ? "" : kind;
  std::replace(words.begin(), words.end(), '|', ' ');
  return words;
}

}  // namespace

std::string last_word(const std::string& path) { return path.substr(path.rfind(' ') + 1); }

bool has_names(const std::string& kind) {
  return kind == "OBJECT" || kind == "FINGER" || kind == "DEVICE" || kind == "MATERIAL";
}

std::string after_choice(const CompletedVerb& verb, const std::string& no_list) {
  return verb.next_value.empty() ? ""
                                 : fmt::format("; case $before in {}) kind='{}' {} ;; esac", verb.value,
                                               verb.next_value, no_list);
}

std::string bash_completion(const std::vector<CompletedVerb>& verbs) {
  std::string text = kBashHead;
  for (const CompletedVerb& verb : verbs) {
    for (const std::string& below : verb.verbs) {
      text += fmt::format("      '{}/{}') verb='{}' ;;\n", verb.path, last_word(below), below);
    }
  }
  text += "    esac\n  done\n  case \"$verb/$before\" in\n";
  for (const CompletedVerb& verb : verbs) {
    for (const CompletedOption& option : verb.options) {
      for (const std::string& name : option.value.empty() ? std::vector<std::string>{} : option.names) {
        text += fmt::format("    '{}/{}') kind='{}' list='{}' ;;\n", verb.path, name,
                            choices(option.value).empty() ? option.value : "", choices(option.value));
      }
    }
  }
  text += "    *)\n      case \"$verb/$word\" in\n";
  for (const CompletedVerb& verb : verbs) {
    std::string options;
    for (const CompletedOption& option : verb.options) {
      options += fmt::format("{}{}", options.empty() ? "" : " ", fmt::join(option.names, " "));
    }
    std::string words = choices(verb.value);
    for (const std::string& below : verb.verbs) {
      words += (words.empty() ? "" : " ") + last_word(below);
    }
    text += fmt::format("        '{}/-'*) list='{}' ;;\n", verb.path, options);
    text += fmt::format("        '{}/'*) kind='{}' list='{}'{} ;;\n", verb.path,
                        choices(verb.value).empty() ? verb.value : "", words, after_choice(verb, "list="));
  }
  return text + "      esac\n      ;;\n  esac" + kBashTail;
}

}  // namespace haptic::cli
