#include "client/doctor/machine.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <sstream>
#include <utility>

namespace haptic::doctor {

namespace {

constexpr std::size_t kMostBytes = 1U << 20U;
constexpr unsigned kMostNumbers = 4096;

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

bool is_number(const std::string& text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
}

std::vector<std::string> split(const std::string& line, char separator) {
  std::vector<std::string> parts;
  std::istringstream in(line);
  for (std::string part; std::getline(in, part, separator);) parts.push_back(part);
  return parts;
}

template <class Number>
std::optional<Number> parsed(const std::string& text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

}  // namespace

Machine::Machine(std::filesystem::path root, User user, bool own_rights)
    : root_(std::move(root)), user_(std::move(user)), own_rights_(own_rights) {}

std::filesystem::path Machine::at(const std::string& path) const {
  return root_ / std::filesystem::path(path).relative_path();
}

bool Machine::exists(const std::string& path) const {
  std::error_code ignored;
  return std::filesystem::exists(at(path), ignored);
}

std::optional<std::string> Machine::text(const std::string& path) const {
  std::ifstream in(at(path), std::ios::binary);
  if (!in) return std::nullopt;
  std::string bytes;
  std::array<char, 4096> chunk{};
  while (bytes.size() < kMostBytes) {
    in.read(chunk.data(), static_cast<std::streamsize>(chunk.size()));
    bytes.append(chunk.data(), static_cast<std::size_t>(in.gcount()));
    if (in.eof()) break;
    if (!in) return std::nullopt;  // a folder, say
  }
  return bytes;
}

std::optional<std::string> Machine::line(const std::string& path) const {
  const std::optional<std::string> whole = text(path);
  if (!whole) return std::nullopt;
  return trimmed(whole->substr(0, whole->find('\n')));
}

std::optional<double> Machine::number(const std::string& path) const {
  const std::optional<std::string> told = line(path);
  return told ? parsed<double>(*told) : std::nullopt;
}

std::vector<std::string> Machine::list(const std::string& path) const {
  std::vector<std::string> names;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(at(path), error), end; !error && entry != end;
       entry.increment(error)) {
    names.push_back(entry->path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::optional<std::string> Machine::link(const std::string& path) const {
  std::error_code error;
  const std::filesystem::path target = std::filesystem::read_symlink(at(path), error);
  return error ? std::nullopt : std::optional(target.string());
}

std::string Machine::resolved(const std::string& path) const {
  std::filesystem::path resolved(path);
  constexpr int kMostLinks = 8;
  for (int i = 0; i < kMostLinks; ++i) {
    const std::optional<std::string> target = link(resolved.string());
    if (!target) break;
    resolved = (resolved.parent_path() / *target).lexically_normal();
  }
  return resolved.string();
}

bool Machine::may(Access access, const std::string& path) const {
  const bool reads = access != Access::kWrite;
  const bool writes = access != Access::kRead;
  if (own_rights_) {
    return ::access(at(path).c_str(), (reads ? R_OK : 0) | (writes ? W_OK : 0)) == 0;
  }
  struct stat status {};
  if (::stat(at(path).c_str(), &status) != 0) return false;
  if (user_.uid == 0) return true;
  unsigned shift = 0;
  if (status.st_uid == user_.uid) {
    shift = 6;
  } else if (std::find(user_.groups.begin(), user_.groups.end(), status.st_gid) != user_.groups.end()) {
    shift = 3;
  }
  const unsigned wanted = (reads ? 4U : 0U) | (writes ? 2U : 0U);
  return (status.st_mode >> shift & wanted) == wanted;
}

std::string Machine::name_of_id(const char* file, unsigned id) const {
  std::istringstream lines(text(file).value_or(""));
  for (std::string entry; std::getline(lines, entry);) {
    const std::vector<std::string> fields = split(entry, ':');
    if (fields.size() > 2 && fields[2] == std::to_string(id)) return fields[0];
  }
  return {};
}

std::string Machine::group_with_rights(const std::string& path) const {
  struct stat status {};
  if (::stat(at(path).c_str(), &status) != 0) return {};
  constexpr unsigned kReadAndWrite = 6;
  if ((status.st_mode >> 3U & kReadAndWrite) != kReadAndWrite || status.st_gid == 0) return {};
  return name_of_id("/etc/group", status.st_gid);
}

std::string Machine::rights(const std::string& path) const {
  struct stat status {};
  if (::stat(at(path).c_str(), &status) != 0) return "absent";
  const std::string owner = name_of_id("/etc/passwd", status.st_uid);
  const std::string group = name_of_id("/etc/group", status.st_gid);
  std::string letters;
  for (const unsigned shift : {6U, 3U, 0U}) {
    const unsigned bits = status.st_mode >> shift;
    letters += (bits & 4U) != 0 ? 'r' : '-';
    letters += (bits & 2U) != 0 ? 'w' : '-';
    letters += (bits & 1U) != 0 ? 'x' : '-';
  }
  return fmt::format("{}:{} {}", owner.empty() ? std::to_string(status.st_uid) : owner,
                     group.empty() ? std::to_string(status.st_gid) : group, letters);
}

std::vector<int> Machine::processes(const std::string& program) const {
  std::vector<int> found;
  for (const std::string& name : list("/proc")) {
    const std::optional<int> pid = is_number(name) ? parsed<int>(name) : std::nullopt;
    if (pid && line("/proc/" + name + "/comm") == program) found.push_back(*pid);
  }
  return found;
}

std::vector<Holder> Machine::holders(const std::string& path) const {
  std::vector<Holder> found;
  for (const std::string& name : list("/proc")) {
    const std::optional<int> pid = is_number(name) ? parsed<int>(name) : std::nullopt;
    if (!pid) continue;
    const std::string folder = "/proc/" + name;
    for (const std::string& file : list(folder + "/fd")) {
      if (link(fmt::format("{}/fd/{}", folder, file)) != path) continue;
      found.push_back({*pid, line(folder + "/comm").value_or("?")});
      break;
    }
  }
  return found;
}

std::optional<User> find_user(const std::filesystem::path& root, const std::string& name) {
  const Machine machine(root, {}, false);
  std::optional<User> user;
  std::istringstream accounts(machine.text("/etc/passwd").value_or(""));
  for (std::string entry; !user && std::getline(accounts, entry);) {
    const std::vector<std::string> fields = split(entry, ':');
    if (fields.size() < 4 || fields[0] != name) continue;
    const auto uid = parsed<uid_t>(fields[2]);
    const auto gid = parsed<gid_t>(fields[3]);
    if (uid && gid) user = User{name, *uid, {*gid}};
  }
  if (!user) return std::nullopt;
  std::istringstream groups(machine.text("/etc/group").value_or(""));
  for (std::string entry; std::getline(groups, entry);) {
    const std::vector<std::string> fields = split(entry, ':');
    if (fields.size() < 4) continue;
    const std::vector<std::string> members = split(fields[3], ',');
    const auto gid = parsed<gid_t>(fields[2]);
    if (gid && std::find(members.begin(), members.end(), name) != members.end()) user->groups.push_back(*gid);
  }
  return user;
}

std::vector<unsigned> numbers_of(const std::string& list) {
  std::vector<unsigned> numbers;
  for (const std::string& part : split(trimmed(list), ',')) {
    const std::size_t dash = part.find('-');
    const auto first = parsed<unsigned>(part.substr(0, dash));
    const auto last = dash == std::string::npos ? first : parsed<unsigned>(part.substr(dash + 1));
    if (!first || !last) continue;
    for (unsigned n = *first; n <= *last && numbers.size() < kMostNumbers; ++n) numbers.push_back(n);
  }
  return numbers;
}

}  // namespace haptic::doctor
