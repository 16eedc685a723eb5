#include "proto/recording/sink.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "proto/recording/error.h"

namespace haptic::recording {

FileSink::FileSink(std::string path, IfThere if_there, Durable durable)
    : path_(std::move(path)), durable_(durable) {
  const int how = if_there == IfThere::kRefuse ? O_EXCL : O_TRUNC;
  file_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | how, 0666);
  if (file_ < 0) {
    fail("cannot be made");
  }
}

FileSink::~FileSink() {
  if (file_ >= 0) {
    ::close(file_);
  }
}

void FileSink::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file_, bytes.data(), bytes.size());
    if (written > 0) {
      bytes.remove_prefix(static_cast<std::size_t>(written));
    } else if (written < 0 && errno != EINTR) {
      fail("cannot be written");
    }
  }
}

void FileSink::truncate(std::uint64_t size) {
  const auto end = static_cast<off_t>(size);
  if (::ftruncate(file_, end) != 0 || ::lseek(file_, end, SEEK_SET) != end) {
    fail("cannot be shortened");
  }
}

void FileSink::sync() {
  // pipes and the like have nothing to sync
  if (durable_ == Durable::kYes && ::fdatasync(file_) != 0 && errno != EINVAL && errno != EROFS) {
    fail("cannot be written");
  }
}

void FileSink::close() {
  if (::close(std::exchange(file_, -1)) != 0 && errno != EINTR) {
    fail("cannot be written");
  }
}

void FileSink::fail(const char* what) const {
  throw IoError(path_ + ": " + what + ": " + std::generic_category().message(errno));
}

}  // namespace haptic::recording
