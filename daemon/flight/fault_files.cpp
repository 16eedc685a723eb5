#include "flight/fault_files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <regex>
#include <system_error>
#include <vector>

#include "proto/recording/error.h"

namespace haptic::flight {

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kNanoseconds = 1'000'000'000;  // in a second
constexpr auto kAbandoned = std::chrono::hours(1);     // a part that is older is a dead daemon's

std::string stem_of(const std::string& fault, std::uint64_t realtime_ns) {
  const auto seconds = static_cast<std::time_t>(realtime_ns / kNanoseconds);
  std::tm utc{};
  ::gmtime_r(&seconds, &utc);
  return fmt::format("fault-{:04}{:02}{:02}T{:02}{:02}{:02}.{:03}Z-{}", utc.tm_year + 1900, utc.tm_mon + 1,
                     utc.tm_mday, utc.tm_hour, utc.tm_min, utc.tm_sec, realtime_ns % kNanoseconds / 1'000'000,
                     fault);
}

bool is_recording(const std::string& name) {
  static const std::regex pattern(R"(fault-\d{8}T\d{6}\.\d{3}Z-[a-z0-9_]+(-\d+)?\.mcap)");
  return std::regex_match(name, pattern);
}

bool is_part(const std::string& name) { return name.starts_with(".fault-") && name.ends_with(".part"); }

// of what cannot be removed others will tell: the next recording, which finds no room
void remove_old(const fs::path& directory, std::uint32_t keep, const fs::path& newest) {
  std::error_code ignored;
  std::vector<fs::path> recordings;
  for (fs::directory_iterator entry(directory, ignored), end; !ignored && entry != end;
       entry.increment(ignored)) {
    const std::string name = entry->path().filename().string();
    // the clock may have been set back since the others were written
    if (is_recording(name) && entry->path() != newest) recordings.push_back(entry->path());
    std::error_code unknown;
    const auto written = entry->last_write_time(unknown);
    if (is_part(name) && !unknown && fs::file_time_type::clock::now() - written > kAbandoned) {
      fs::remove(entry->path(), unknown);
    }
  }
  std::sort(recordings.begin(), recordings.end());
  for (std::size_t i = 0; i + keep < recordings.size() + 1; ++i) fs::remove(recordings[i], ignored);
}

fs::path unused(const fs::path& directory, const std::string& stem) {
  std::error_code ignored;
  fs::path path = directory / (stem + ".mcap");
  for (int i = 2; fs::exists(path, ignored); ++i) path = directory / fmt::format("{}-{}.mcap", stem, i);
  return path;
}

void sync_directory(const fs::path& directory) noexcept {
  const int descriptor = ::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

void write_file(const Excerpt& excerpt, const std::string& path) {
  recording::FileSink sink(path, recording::FileSink::IfThere::kReplace, recording::FileSink::Durable::kYes);
  write(excerpt, sink);
  sink.close();
}

}  // namespace

std::string directory_of(const v1::FlightRecorder& config) {
  if (!config.directory().empty()) return config.directory();
  const char* const logs = std::getenv("LOGS_DIRECTORY");
  if (logs == nullptr || *logs == '\0') return {};
  const std::string first = std::string(logs).substr(0, std::string(logs).find(':'));
  return (fs::path(first) / "faults").string();
}

std::string find_problem(const std::string& directory) {
  if (::mkdir(directory.c_str(), 0750) != 0 && errno != EEXIST) {
    return directory + ": cannot be made: " + std::generic_category().message(errno);
  }
  if (std::error_code ignored; !fs::is_directory(directory, ignored)) return directory + ": is no directory";
  if (::access(directory.c_str(), W_OK | X_OK) != 0) {
    return directory + ": cannot be written to: " + std::generic_category().message(errno);
  }
  return {};
}

std::string save(const Excerpt& excerpt, const std::string& directory, std::uint32_t keep,
                 const std::string& fault, std::uint64_t realtime_ns) {
  if (const std::string problem = find_problem(directory); !problem.empty()) {
    throw recording::IoError(problem);
  }
  const std::string stem = stem_of(fault, realtime_ns);
  const fs::path part = fs::path(directory) / ("." + stem + ".part");
  std::error_code ignored;
  try {
    write_file(excerpt, part.string());
  } catch (const std::exception&) {
    fs::remove(part, ignored);
    throw;
  }
  const fs::path path = unused(directory, stem);
  if (::rename(part.c_str(), path.c_str()) != 0) {
    const std::string reason = std::generic_category().message(errno);
    fs::remove(part, ignored);
    throw recording::IoError(path.string() + ": cannot be made: " + reason);
  }
  sync_directory(directory);
  remove_old(directory, keep, path);
  return path.string();
}

}  // namespace haptic::flight
