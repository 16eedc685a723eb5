#include "proto/recording/source.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "proto/recording/error.h"

namespace haptic::recording {
namespace {

void expect_inside(std::uint64_t offset, std::size_t length, std::uint64_t size) {
  if (offset > size || length > size - offset) {
    throw FormatError("bytes " + std::to_string(offset) + " to " + std::to_string(offset) + " + " +
                      std::to_string(length) + " are beyond the end of the file at " + std::to_string(size));
  }
}

}  // namespace

FileSource::FileSource(std::string path) : path_(std::move(path)) {
  file_ = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat status {};
  if (file_ < 0 || ::fstat(file_, &status) != 0) {
    fail();
  }
  if (!S_ISREG(status.st_mode)) {
    ::close(file_);
    throw IoError(path_ + ": is no regular file");
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

FileSource::~FileSource() { ::close(file_); }

void FileSource::read(std::uint64_t offset, std::size_t length, std::string& out) const {
  expect_inside(offset, length, size_);
  out.resize(length);
  std::size_t done = 0;
  while (done < length) {
    const ssize_t got = ::pread(file_, out.data() + done, length - done, static_cast<off_t>(offset + done));
    if (got > 0) {
      done += static_cast<std::size_t>(got);
    } else if (got == 0) {
      throw IoError(path_ + ": was shortened while it was read");
    } else if (errno != EINTR) {
      fail();
    }
  }
}

void FileSource::fail() const {
  throw IoError(path_ + ": cannot be read: " + std::generic_category().message(errno));
}

void MemorySource::read(std::uint64_t offset, std::size_t length, std::string& out) const {
  expect_inside(offset, length, bytes_.size());
  out = bytes_.substr(static_cast<std::size_t>(offset), length);
}

}  // namespace haptic::recording
