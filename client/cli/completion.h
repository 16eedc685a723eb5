#pragma once
// Scripts with which shells complete hapticctl's arguments, made from its own parser, so that they know what
// it knows. Names of objects and the like they ask of the running daemon, through the hidden verb __names.

#include <string>
#include <vector>

#include "client/cli/parser.h"

namespace haptic::cli {

/// The last word of a path.
std::string last_word(const std::string& path);

/// Whether __names knows the kind: OBJECT, FINGER, DEVICE, MATERIAL. The other kinds that can be completed
/// are FILE, and words with | between them.
bool has_names(const std::string& kind);

/// For bash and zsh: after a word of the first argument the kind is that of the second, and `no_list` is
/// done. Empty if there is no second.
std::string after_choice(const CompletedVerb& verb, const std::string& no_list);

std::string bash_completion(const std::vector<CompletedVerb>& verbs);
std::string zsh_completion(const std::vector<CompletedVerb>& verbs);
std::string fish_completion(const std::vector<CompletedVerb>& verbs);

}  // namespace haptic::cli
