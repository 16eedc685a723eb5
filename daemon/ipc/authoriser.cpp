#include "ipc/authoriser.h"

#include <grp.h>
#include <pwd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

namespace haptic::ipc {
namespace {

// enough for an entry of the user or group database; those with more members than fit are refused in words
constexpr std::size_t kEntryBytes = std::size_t{64} * 1024;

std::optional<gid_t> find_group(const std::string& name) {
  group entry{};
  group* found = nullptr;
  std::vector<char> buffer(kEntryBytes);
  ::getgrnam_r(name.c_str(), &entry, buffer.data(), buffer.size(), &found);
  return found == nullptr ? std::nullopt : std::optional<gid_t>(found->gr_gid);
}

}  // namespace

std::optional<PeerCredentials> peer_credentials(int socket) noexcept {
  ucred credentials{};
  socklen_t size = sizeof(credentials);
  if (::getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &credentials, &size) != 0) {
    return std::nullopt;
  }
  return PeerCredentials{credentials.uid, credentials.gid, credentials.pid};
}

std::vector<gid_t> groups_of(const PeerCredentials& peer) {
  passwd entry{};
  passwd* found = nullptr;
  std::vector<char> buffer(kEntryBytes);
  ::getpwuid_r(peer.user, &entry, buffer.data(), buffer.size(), &found);
  std::vector<gid_t> groups = {peer.group};
  if (found == nullptr) {
    return groups;
  }
  int count = 64;
  groups.resize(static_cast<std::size_t>(count));
  if (::getgrouplist(found->pw_name, peer.group, groups.data(), &count) < 0) {
    groups.resize(static_cast<std::size_t>(count));
    ::getgrouplist(found->pw_name, peer.group, groups.data(), &count);
  }
  groups.resize(static_cast<std::size_t>(count));
  return groups;
}

Authoriser Authoriser::from_config(const v1::Listen::Unix& config) {
  std::vector<Entry> entries;
  for (const v1::Listen::Allow& allow : config.allow()) {
    const std::optional<gid_t> group = find_group(allow.group());
    if (!group) {
      throw std::runtime_error("listen.unix.allow: there is no group \"" + allow.group() + "\"");
    }
    if (allow.role() < v1::OBSERVE || allow.role() > v1::ADMIN) {
      throw std::runtime_error("listen.unix.allow: group \"" + allow.group() +
                               "\" needs a role: OBSERVE, SCRIPT, DRIVE or ADMIN");
    }
    entries.push_back({*group, allow.role()});
  }
  return Authoriser(::geteuid(), std::move(entries));
}

std::optional<v1::Role> Authoriser::role_of(const PeerCredentials& peer,
                                            const std::vector<gid_t>& groups) const noexcept {
  if (peer.user == 0 || peer.user == owner_) {
    return v1::ADMIN;
  }
  std::optional<v1::Role> best;
  for (const Entry& entry : entries_) {
    if (std::find(groups.begin(), groups.end(), entry.group) != groups.end() &&
        (!best || entry.role > *best)) {
      best = entry.role;
    }
  }
  return best;
}

}  // namespace haptic::ipc
