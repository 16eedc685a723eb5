#pragma once
// Where a recording goes.

#include <cstdint>
#include <string>
#include <string_view>

namespace haptic::recording {

class Sink {
 public:
  virtual ~Sink() = default;

  /// Appends all of it. Throws IoError; some of it may then be there.
  virtual void write(std::string_view bytes) = 0;

  /// Forgets everything after so many bytes, where the next write() goes on. Throws IoError.
  virtual void truncate(std::uint64_t size) = 0;

  /// Returns when all that was written survives a loss of power. Throws IoError.
  virtual void sync() = 0;
};

/// A file. Not moved, not copied.
class FileSink : public Sink {
 public:
  enum class IfThere { kRefuse, kReplace };
  /// With kNo sync() does nothing.
  enum class Durable { kYes, kNo };

  /// Makes the file. Throws IoError.
  FileSink(std::string path, IfThere if_there, Durable durable);
  ~FileSink() override;
  FileSink(const FileSink&) = delete;
  FileSink& operator=(const FileSink&) = delete;

  void write(std::string_view bytes) override;
  void truncate(std::uint64_t size) override;
  void sync() override;

  /// Some file systems tell only now that the disk is full. Throws IoError. Nothing may be called after it.
  void close();

  const std::string& path() const noexcept { return path_; }

 private:
  [[noreturn]] void fail(const char* what) const;

  std::string path_;
  Durable durable_;
  int file_ = -1;
};

}  // namespace haptic::recording
