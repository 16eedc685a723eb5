#include "client/cli/scene_text.h"

#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/text_format.h>
#include <google/protobuf/util/json_util.h>

#include <fstream>
#include <iterator>

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

}  // namespace

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
  if (path.size() >= 5 && path.substr(path.size() - 5) == ".json") {
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
