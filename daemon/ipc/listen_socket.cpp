#include "ipc/listen_socket.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <linux/posix_acl.h>
#include <linux/posix_acl_xattr.h>
#include <netinet/in.h>
#include <spdlog/spdlog.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/xattr.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>
#include <vector>

#include "proto/socket_path.h"

namespace haptic::ipc {
namespace {

constexpr int kBacklog = 64;
constexpr const char* kAccessList = "system.posix_acl_access";

std::string reason() { return std::strerror(errno); }

sockaddr_un name_of(const std::string& path) {
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof(name.sun_path)) {
    throw ListenError("listen.unix.path: a socket's path has 1 to " +
                      std::to_string(sizeof(name.sun_path) - 1) + " bytes; this one has " +
                      std::to_string(path.size()) + ": " + path);
  }
  path.copy(name.sun_path, path.size());
  return name;
}

// makes the directory if need be; nobody else may write there, or could put a socket of his own in its place
void make_private_directory(const std::string& directory) {
  if (::mkdir(directory.c_str(), 0700) != 0 && errno != EEXIST) {
    throw ListenError("cannot make the directory " + directory + ": " + reason());
  }
  struct stat status {};
  if (::lstat(directory.c_str(), &status) != 0 || !S_ISDIR(status.st_mode) || status.st_uid != ::geteuid() ||
      (status.st_mode & 0022U) != 0) {
    throw ListenError(directory + " is not a directory that only you can write to; remove it, or set " +
                      "HAPTICD_SOCKET to another place");
  }
}

// an access list with room for named groups: owner and each group read and write, others nothing
std::vector<char> access_list(const std::vector<Authoriser::Entry>& groups) {
  std::vector<gid_t> ids;
  ids.reserve(groups.size());
  for (const Authoriser::Entry& entry : groups) {
    ids.push_back(entry.group);
  }
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());

  constexpr std::uint16_t kReadWrite = ACL_READ | ACL_WRITE;
  constexpr auto kNoId = static_cast<std::uint32_t>(ACL_UNDEFINED_ID);
  std::vector<posix_acl_xattr_entry> entries;
  entries.push_back({ACL_USER_OBJ, kReadWrite, kNoId});
  entries.push_back({ACL_GROUP_OBJ, kReadWrite, kNoId});
  for (const gid_t id : ids) {
    entries.push_back({ACL_GROUP, kReadWrite, id});
  }
  entries.push_back({ACL_MASK, kReadWrite, kNoId});
  entries.push_back({ACL_OTHER, 0, kNoId});

  const posix_acl_xattr_header header{POSIX_ACL_XATTR_VERSION};
  std::vector<char> bytes(sizeof(header) + entries.size() * sizeof(entries[0]));
  std::memcpy(bytes.data(), &header, sizeof(header));
  std::memcpy(bytes.data() + sizeof(header), entries.data(), entries.size() * sizeof(entries[0]));
  return bytes;
}

bool is_loopback(const sockaddr_storage& address) noexcept {
  if (address.ss_family == AF_INET) {
    const auto& v4 = reinterpret_cast<const sockaddr_in&>(address);
    return (ntohl(v4.sin_addr.s_addr) >> 24) == 127;
  }
  const auto& v6 = reinterpret_cast<const sockaddr_in6&>(address);
  return IN6_IS_ADDR_LOOPBACK(&v6.sin6_addr);
}

}  // namespace

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  std::swap(value_, other.value_);
  return *this;
}

Descriptor::~Descriptor() {
  if (value_ >= 0) {
    ::close(value_);
  }
}

int Descriptor::release() noexcept { return std::exchange(value_, -1); }

std::string default_socket_path() {
  if (const char* path = std::getenv("HAPTICD_SOCKET"); path != nullptr && *path != '\0') {
    return path;
  }
  if (const char* directory = std::getenv("RUNTIME_DIRECTORY"); directory != nullptr && *directory != '\0') {
    return std::string(directory) + "/hapticd.sock";
  }
  const std::string directory = proto::user_socket_directory();
  make_private_directory(directory);
  return directory + "/hapticd.sock";
}

std::string path_of_passed(int socket) {
  const std::string number = "descriptor " + std::to_string(socket) + " of the service manager";
  int type = 0;
  int listens = 0;
  socklen_t size = sizeof(type);
  if (::getsockopt(socket, SOL_SOCKET, SO_TYPE, &type, &size) != 0 || type != SOCK_STREAM ||
      ::getsockopt(socket, SOL_SOCKET, SO_ACCEPTCONN, &listens, &size) != 0 || listens == 0) {
    throw ListenError(number + " is no stream socket that listens");
  }
  sockaddr_un name{};
  socklen_t length = sizeof(name);
  if (::getsockname(socket, reinterpret_cast<sockaddr*>(&name), &length) != 0 || name.sun_family != AF_UNIX ||
      name.sun_path[0] == '\0') {
    throw ListenError(number + " is no Unix socket with a path; ListenStream= must name a path");
  }
  return {name.sun_path, ::strnlen(name.sun_path, sizeof(name.sun_path))};
}

UnixListener::UnixListener(const v1::Listen::Unix& config)
    : path_(config.path().empty() ? default_socket_path() : config.path()), is_own_(true) {
  static_cast<void>(name_of(path_));
  const std::filesystem::path directory = std::filesystem::absolute(path_).parent_path();
  if (!std::filesystem::is_directory(directory)) {
    throw ListenError("cannot listen on " + path_ + ": there is no directory " + directory.string() +
                      "; make it, or choose another listen.unix.path");
  }
  take_lock();
  remove_stale();
  bind();
  // nobody can connect before listen(), so there is no moment in which the wrong people could
  if (::chmod(path_.c_str(), 0660) != 0) {
    throw ListenError("cannot set the mode of " + path_ + ": " + reason());
  }
  admit(Authoriser::from_config(config));
  if (::listen(socket_.get(), kBacklog) != 0) {
    throw ListenError("cannot listen on " + path_ + ": " + reason());
  }
}

UnixListener::UnixListener(const v1::Listen::Unix& config, Descriptor passed)
    : path_(path_of_passed(passed.get())), is_own_(false), socket_(std::move(passed)) {
  admit(Authoriser::from_config(config));
}

UnixListener::~UnixListener() {
  if (!is_own_) {
    return;
  }
  // before the lock goes: a socket there is still ours
  struct stat status {};
  if (::lstat(path_.c_str(), &status) == 0 && S_ISSOCK(status.st_mode)) {
    ::unlink(path_.c_str());
  }
}

void UnixListener::take_lock() {
  const std::string file = path_ + ".lock";
  Descriptor lock(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600));
  if (lock.get() < 0) {
    throw ListenError("cannot listen on " + path_ + ": cannot open its lock " + file + ": " + reason());
  }
  if (::flock(lock.get(), LOCK_EX | LOCK_NB) != 0) {
    throw ListenError("another hapticd listens on " + path_ +
                      "; stop it, or choose another listen.unix.path");
  }
  lock_ = std::move(lock);
}

// the lock is ours, so no daemon that knows of locks is alive; whoever else may listen there is asked
void UnixListener::remove_stale() {
  struct stat status {};
  if (::lstat(path_.c_str(), &status) != 0) {
    return;
  }
  if (!S_ISSOCK(status.st_mode)) {
    throw ListenError("cannot listen on " + path_ + ": there is a file of that name which is no socket");
  }
  const sockaddr_un name = name_of(path_);
  const Descriptor probe(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (::connect(probe.get(), reinterpret_cast<const sockaddr*>(&name), sizeof(name)) == 0 ||
      errno == EAGAIN) {
    throw ListenError("another program listens on " + path_ +
                      "; stop it, or choose another listen.unix.path");
  }
  if (::unlink(path_.c_str()) != 0) {
    throw ListenError("cannot remove the socket that a dead daemon left at " + path_ + ": " + reason());
  }
}

void UnixListener::bind() {
  const sockaddr_un name = name_of(path_);
  socket_ = Descriptor(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (socket_.get() < 0 ||
      ::bind(socket_.get(), reinterpret_cast<const sockaddr*>(&name), sizeof(name)) != 0) {
    throw ListenError("cannot listen on " + path_ + ": " + reason());
  }
}

void UnixListener::admit(const Authoriser& authoriser) const {
  if (authoriser.entries().empty()) {
    ::removexattr(path_.c_str(), kAccessList);  // of a reload before; there may be none
    return;
  }
  const std::vector<char> list = access_list(authoriser.entries());
  if (::setxattr(path_.c_str(), kAccessList, list.data(), list.size(), 0) == 0) {
    return;
  }
  // a file system without access lists: the first group is better than none
  const std::string why = reason();
  const gid_t first = authoriser.entries().front().group;
  const bool owned = is_own_ && ::chown(path_.c_str(), static_cast<uid_t>(-1), first) == 0;
  spdlog::warn("{} has no access list ({}); {}", path_, why,
               owned     ? "only the first group of listen.unix.allow can connect"
               : is_own_ ? "only the user who runs hapticd can connect"
                         : "only who has the mode of the service manager's socket on his side can connect");
}

int listen_tcp(const v1::Listen::Tcp& config) {
  const std::string text = config.address() + " port " + std::to_string(config.port());
  sockaddr_storage address{};
  socklen_t size = 0;
  auto& v4 = reinterpret_cast<sockaddr_in&>(address);
  auto& v6 = reinterpret_cast<sockaddr_in6&>(address);
  if (config.port() > 65535) {
    throw ListenError("listen.tcp.port: " + std::to_string(config.port()) + " is not in 0 to 65535");
  }
  const auto port = htons(static_cast<std::uint16_t>(config.port()));
  if (::inet_pton(AF_INET, config.address().c_str(), &v4.sin_addr) == 1) {
    v4.sin_family = AF_INET;
    v4.sin_port = port;
    size = sizeof(v4);
  } else if (::inet_pton(AF_INET6, config.address().c_str(), &v6.sin6_addr) == 1) {
    v6.sin6_family = AF_INET6;
    v6.sin6_port = port;
    size = sizeof(v6);
  } else {
    throw ListenError("listen.tcp.address: \"" + config.address() + "\" is no IPv4 or IPv6 address");
  }
  if (!config.has_tls() && !is_loopback(address)) {
    throw ListenError("listen.tcp.address: " + config.address() +
                      " is not loopback; without TLS the daemon listens on 127.0.0.1 or ::1 only");
  }
  Descriptor socket(::socket(address.ss_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const int on = 1;
  ::setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
  if (socket.get() < 0 || ::bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), size) != 0 ||
      ::listen(socket.get(), kBacklog) != 0) {
    throw ListenError("cannot listen on " + text + ": " + reason());
  }
  return socket.release();
}

}  // namespace haptic::ipc
