#pragma once
// Who has connected, as far as the daemon can know it itself, and what he may do.
//
//     Unix socket     by the kernel's word about the peer (authoriser.h)
//     TCP with TLS    by the names in the certificate
//     TCP             nobody knows: observing only

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "ipc/authoriser.h"

namespace haptic::ipc {

struct Peer {
  std::optional<v1::Role> role;  // nothing: it is refused, in words, when it says hello
  std::string user;              // the same for all connections that count together
  std::string name;              // for a person
  std::string refusal;           // why there is no role
};

/// Decides instead of the config, in tests.
using RoleOf = std::function<std::optional<v1::Role>(const PeerCredentials&)>;

Peer local_peer(const std::optional<PeerCredentials>& credentials, const Authoriser& authoriser,
                const RoleOf& instead);

/// The highest role of all that the names have; a name counts only if it is exactly the one of the config.
Peer certified_peer(const std::vector<std::string>& names, const std::vector<v1::Listen::AllowName>& allow);

Peer unknown_peer();

}  // namespace haptic::ipc
