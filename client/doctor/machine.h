#pragma once
// What of a machine the doctor looks at: files below a root, which is "/", or a folder that a test has made.
// It only reads, and what cannot be read is absent.

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace haptic::doctor {

/// Who is to run the daemon.
struct User {
  std::string name;
  uid_t uid = 0;
  std::vector<gid_t> groups{};
};

enum class Access { kRead, kWrite, kReadAndWrite };

/// A process that has a file open.
struct Holder {
  int pid = 0;
  std::string program;  // as the kernel names it, 15 characters at most
};

class Machine {
 public:
  /// `own_rights`: the user is the one who runs this program, on the machine itself; then the kernel is asked
  /// what may be opened, which knows access control lists, too.
  Machine(std::filesystem::path root, User user, bool own_rights);

  const User& user() const noexcept { return user_; }

  bool exists(const std::string& path) const;
  /// The file's text; nothing if it cannot be read.
  std::optional<std::string> text(const std::string& path) const;
  /// The first line, without what is white at its ends.
  std::optional<std::string> line(const std::string& path) const;
  std::optional<double> number(const std::string& path) const;
  /// Names in the folder, sorted.
  std::vector<std::string> list(const std::string& path) const;
  /// What the link at `path` says; nothing if it is none.
  std::optional<std::string> link(const std::string& path) const;
  /// The path behind a link such as /dev/serial/by-id/..., else the path itself.
  std::string resolved(const std::string& path) const;

  /// Whether the user may open it so.
  bool may(Access access, const std::string& path) const;
  /// The group of the file if its members may read and write it; empty if they may not, or it has no name.
  std::string group_with_rights(const std::string& path) const;
  /// "root:plugdev rw-rw----"
  std::string rights(const std::string& path) const;

  /// Processes of this name.
  std::vector<int> processes(const std::string& program) const;
  /// Those that have the file open, as far as it can be seen: of other users, root sees them only.
  std::vector<Holder> holders(const std::string& path) const;

 private:
  std::filesystem::path at(const std::string& path) const;
  std::string name_of_id(const char* file, unsigned id) const;

  std::filesystem::path root_;
  User user_;
  bool own_rights_;
};

/// The user of that name from /etc/passwd and /etc/group below `root`; nothing if there is none.
std::optional<User> find_user(const std::filesystem::path& root, const std::string& name);

/// The numbers of a kernel's list such as "0-3,8".
std::vector<unsigned> numbers_of(const std::string& list);

}  // namespace haptic::doctor
