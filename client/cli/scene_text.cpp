#include "client/cli/scene_text.h"

#include <fcntl.h>
#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/text_format.h>
#include <google/protobuf/util/json_util.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string_view>

#include "client/lib/error.h"

namespace haptic::cli {
namespace {

// keeps the first mistake
class FirstMistake : public google::protobuf::io::ErrorCollector {
 public:
  void AddError(int line, int column, const std::string& message) override {
    if (error_.message().empty()) {
      error_.set_message(message);
      error_.set_line(static_cast<std::uint32_t>(line + 1));
      error_.set_column(static_cast<std::uint32_t>(column + 1));
    }
  }
  v1::Error error_;
};

bool is_json(const std::string& path) { return path.size() >= 5 && path.substr(path.size() - 5) == ".json"; }

std::string text_of(const v1::Scene& scene, const std::string& path) {
  std::string text;
  if (is_json(path)) {
    google::protobuf::util::JsonPrintOptions options;
    options.add_whitespace = true;
    options.preserve_proto_field_names = true;
    google::protobuf::util::MessageToJsonString(scene, &text, options);
    return text;
  }
  google::protobuf::TextFormat::PrintToString(scene, &text);
  return "# proto-file: haptic/v1/scene.proto\n# proto-message: haptic.v1.Scene\n" + text;
}

[[noreturn]] void fail_to_write(const std::string& path, const std::string& reason) {
  v1::Error error;
  error.set_code(v1::Error::FAILED);
  error.set_message("cannot write " + path + ": " + reason);
  client::throw_error(error);
}

// a file beside the one that is to be, which takes its place when it is whole
class Draft {
 public:
  explicit Draft(const std::string& path) : path_(path), name_(path + ".XXXXXX") {
    descriptor_ = ::mkostemp(name_.data(), O_CLOEXEC);
    if (descriptor_ < 0) {
      fail_to_write(path_, std::strerror(errno));
    }
  }
  ~Draft() {
    ::close(descriptor_);
    ::unlink(name_.c_str());
  }
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;

  void write(std::string_view text) {
    while (!text.empty()) {
      const ssize_t written = ::write(descriptor_, text.data(), text.size());
      if (written < 0 && errno != EINTR) {
        fail_to_write(path_, std::strerror(errno));
      }
      text.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(written, 0)));
    }
    // readable as other new files are; mkostemp keeps it to oneself
    const mode_t mask = ::umask(0);
    ::umask(mask);
    if (::fchmod(descriptor_, 0666 & ~mask) != 0 || ::fsync(descriptor_) != 0) {
      fail_to_write(path_, std::strerror(errno));
    }
  }

  // a link, unlike a rename, never replaces
  void publish(bool force) {
    const int result =
        force ? std::rename(name_.c_str(), path_.c_str()) : ::link(name_.c_str(), path_.c_str());
    if (result != 0) {
      fail_to_write(path_, errno == EEXIST ? "it exists; --force replaces it" : std::strerror(errno));
    }
  }

 private:
  std::string path_;
  std::string name_;
  int descriptor_ = -1;
};

}  // namespace

void write_scene_text(const v1::Scene& scene, const std::string& path, bool force) {
  Draft draft(path);
  draft.write(text_of(scene, path));
  draft.publish(force);
}

std::string parse_text(const std::string& text, google::protobuf::Message& message) {
  FirstMistake mistake;
  google::protobuf::TextFormat::Parser parser;
  parser.RecordErrorsTo(&mistake);
  if (parser.ParseFromString(text, &message)) {
    return "";
  }
  const v1::Error& error = mistake.error_;
  return std::to_string(error.line()) + ":" + std::to_string(error.column()) + ": " + error.message();
}

v1::Scene read_scene_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  FirstMistake mistake;
  if (!file) {
    mistake.error_.set_code(v1::Error::NOT_FOUND);
    mistake.error_.set_message("cannot read " + path);
    client::throw_error(mistake.error_);
  }
  v1::Scene scene;
  bool read = false;
  if (is_json(path)) {
    const auto status = google::protobuf::util::JsonStringToMessage(text, &scene);
    read = status.ok();
    mistake.error_.set_message(std::string(status.message()));
  } else {
    google::protobuf::TextFormat::Parser parser;
    parser.RecordErrorsTo(&mistake);
    read = parser.ParseFromString(text, &scene);
  }
  if (!read) {
    mistake.error_.set_code(v1::Error::INVALID);
    mistake.error_.set_file(path);
    client::throw_error(mistake.error_);
  }
  return scene;
}

}  // namespace haptic::cli
