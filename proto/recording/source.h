#pragma once
// Where a recording comes from: bytes at offsets.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace haptic::recording {

class Source {
 public:
  virtual ~Source() = default;

  /// In bytes; stays the same.
  virtual std::uint64_t size() const = 0;

  /// Replaces `out` by the bytes from `offset` on; all of them must be there: FormatError. Throws IoError.
  virtual void read(std::uint64_t offset, std::size_t length, std::string& out) const = 0;
};

/// A file as long as it was when this was made; what is appended meanwhile is not seen.
class FileSource : public Source {
 public:
  /// Throws IoError, e.g. if it is no regular file.
  explicit FileSource(std::string path);
  ~FileSource() override;
  FileSource(const FileSource&) = delete;
  FileSource& operator=(const FileSource&) = delete;

  std::uint64_t size() const override { return size_; }
  void read(std::uint64_t offset, std::size_t length, std::string& out) const override;

 private:
  [[noreturn]] void fail() const;

  std::string path_;
  int file_ = -1;
  std::uint64_t size_ = 0;
};

/// Bytes in memory, which outlive this.
class MemorySource : public Source {
 public:
  explicit MemorySource(std::string_view bytes) noexcept : bytes_(bytes) {}
  std::uint64_t size() const override { return bytes_.size(); }
  void read(std::uint64_t offset, std::size_t length, std::string& out) const override;

 private:
  std::string_view bytes_;
};

}  // namespace haptic::recording
