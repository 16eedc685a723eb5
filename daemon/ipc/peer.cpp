#include "ipc/peer.h"

#include <pwd.h>

namespace haptic::ipc {
namespace {

std::string name_of_user(uid_t user) {
  passwd entry{};
  passwd* found = nullptr;
  std::vector<char> buffer(std::size_t{16} * 1024);
  ::getpwuid_r(user, &entry, buffer.data(), buffer.size(), &found);
  return found == nullptr ? std::to_string(user) : found->pw_name;
}

}  // namespace

Peer local_peer(const std::optional<PeerCredentials>& credentials, const Authoriser& authoriser,
                const RoleOf& instead) {
  Peer peer;
  peer.refusal = "your user may not use this daemon; its config allows groups in listen.unix.allow";
  if (!credentials) {
    return peer;
  }
  peer.role = instead ? instead(*credentials) : authoriser.role_of(*credentials, groups_of(*credentials));
  peer.user = "user " + std::to_string(credentials->user);
  peer.name =
      "user " + name_of_user(credentials->user) + " (process " + std::to_string(credentials->process) + ")";
  return peer;
}

Peer certified_peer(const std::vector<std::string>& names, const std::vector<v1::Listen::AllowName>& allow) {
  Peer peer;
  for (const std::string& name : names) {
    for (const v1::Listen::AllowName& entry : allow) {
      if (entry.name() == name && (!peer.role || entry.role() > *peer.role)) {
        peer.role = entry.role();
        peer.name = name;
      }
    }
  }
  if (!peer.role) {
    peer.name = names.empty() ? "" : names.front();
    peer.refusal = (names.empty() ? "your certificate, which has no name,"
                                  : "the certificate of \"" + peer.name + "\"") +
                   " may not use this daemon; its config allows names in listen.tcp.allow";
  }
  peer.user = "certificate " + peer.name;
  return peer;
}

Peer unknown_peer() { return {v1::OBSERVE, "tcp", "a client over TCP", ""}; }

}  // namespace haptic::ipc
