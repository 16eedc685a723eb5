#pragma once
// Who may do what: a role for whoever connects, decided by the kernel's word about the peer (SO_PEERCRED),
// never by what the peer says.
//
//     root, the user who runs the daemon   ADMIN
//     a member of groups in the config     the highest of their roles
//     anybody else                         nothing; refused in words

#include <sys/types.h>

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "haptic/v1/config.pb.h"

namespace haptic::ipc {

struct PeerCredentials {
  uid_t user = 0;
  gid_t group = 0;
  pid_t process = 0;
};

/// Of the peer of a Unix socket, as it was when it connected.
std::optional<PeerCredentials> peer_credentials(int socket) noexcept;

/// All groups of the peer: those of its user in the system's database, and the one it runs under.
std::vector<gid_t> groups_of(const PeerCredentials& peer);

class Authoriser {
 public:
  struct Entry {
    gid_t group;
    v1::Role role;
  };

  /// Looks the groups up. Throws std::runtime_error in words if there is no such group, or no role.
  static Authoriser from_config(const v1::Listen::Unix& config);

  Authoriser(uid_t owner, std::vector<Entry> entries) : owner_(owner), entries_(std::move(entries)) {}

  /// Nothing: refused. `groups`: all that the peer is in.
  std::optional<v1::Role> role_of(const PeerCredentials& peer,
                                  const std::vector<gid_t>& groups) const noexcept;

  const std::vector<Entry>& entries() const noexcept { return entries_; }

 private:
  uid_t owner_;
  std::vector<Entry> entries_;
};

}  // namespace haptic::ipc
