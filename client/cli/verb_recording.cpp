#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <memory>

#include "client/cli/describe.h"
#include "client/cli/look.h"
#include "client/cli/table.h"
#include "client/cli/verbs.h"
#include "proto/recording/error.h"
#include "proto/recording/recording.h"
#include "proto/recording/recover.h"
#include "proto/recording/session.h"

namespace haptic::cli {
namespace {

using recording::FileSink;
using recording::FileSource;
using recording::Recording;

// what the bytes of a recording say, beside its own lists
struct Contents {
  std::vector<v1::SceneDescription> scenes;
  std::uint64_t gaps = 0;
  std::uint64_t lost_frames = 0;
  std::uint64_t states = 0;  // from which a replay can start
  v1::Gap lost_inputs;       // the first gap in what a replay needs
  bool has_lost_inputs = false;
};

Contents contents_of(const Recording& recording) {
  Contents contents;
  for (auto messages = recording.messages({.topics = {recording::kSceneTopic}}); messages.next();) {
    messages.parse(contents.scenes.emplace_back());
  }
  for (auto messages = recording.messages({.topics = {recording::kGapsTopic}}); messages.next();) {
    v1::Gap gap;
    messages.parse(gap);
    const bool is_of_inputs =
        std::find(gap.topic().begin(), gap.topic().end(), v1::INPUTS) != gap.topic().end();
    if (!is_of_inputs) {
      ++contents.gaps;
      contents.lost_frames += gap.last_sequence() - gap.first_sequence() + 1;
    } else if (!contents.has_lost_inputs) {
      contents.lost_inputs = gap;
      contents.has_lost_inputs = true;
    }
  }
  for (auto messages = recording.messages({.topics = {recording::kStateTopic}}); messages.next();) {
    ++contents.states;
  }
  return contents;
}

// whether hapticctl replay can do something with it
std::string replay_of(const Contents& contents) {
  if (contents.states == 0) {
    return "no: it has no state to start from";
  }
  if (!contents.has_lost_inputs) {
    return "yes";
  }
  return fmt::format("with gaps, the first at ticks {} to {}", contents.lost_inputs.first_tick(),
                     contents.lost_inputs.last_tick());
}

double seconds_of(const recording::Statistics& statistics) {
  return static_cast<double>(statistics.end_time - statistics.start_time) * 1e-9;
}

std::uint64_t messages_of(const recording::Statistics& statistics, std::uint16_t channel) {
  const auto found = statistics.channel_message_counts.find(channel);
  return found == statistics.channel_message_counts.end() ? 0 : found->second;
}

// Hz over the whole recording; 0 where that means nothing
double rate_of(std::uint64_t messages, double seconds) {
  return messages < 2 || seconds <= 0.0 ? 0.0 : static_cast<double>(messages - 1) / seconds;
}

// "2026-11-21 12:34:56 UTC"; a virtual clock begins at 0
std::string moment(std::uint64_t ns) {
  const auto seconds = static_cast<std::time_t>(ns / 1'000'000'000);
  std::tm utc{};
  return ::gmtime_r(&seconds, &utc) == nullptr ? std::string("-") : fmt::format("{:%F %T} UTC", utc);
}

void print_info_json(const std::string& file, std::uint64_t size, const Recording& recording,
                     const recording::Metadata& session, const Contents& contents) {
  const recording::Statistics& statistics = recording.statistics();
  google::protobuf::Struct info;
  auto& fields = *info.mutable_fields();
  fields["file"] = json(file);
  fields["bytes"] = json(static_cast<double>(size));
  fields["library"] = json(recording.header().library);
  for (const auto& [key, value] : session.metadata) {
    fields[key] = json(value);
  }
  fields["whole"].set_bool_value(recording.damage().empty());
  fields["damage"] = json(recording.damage());
  fields["start_ns"] = json(std::to_string(statistics.start_time));
  fields["end_ns"] = json(std::to_string(statistics.end_time));
  fields["seconds"] = json(seconds_of(statistics));
  fields["messages"] = json(static_cast<double>(statistics.message_count));
  fields["chunks"] = json(static_cast<double>(statistics.chunk_count));
  fields["gaps"] = json(static_cast<double>(contents.gaps));
  fields["lost_frames"] = json(static_cast<double>(contents.lost_frames));
  fields["replay"] = json(replay_of(contents));
  auto& channels = *fields["channels"].mutable_list_value();
  for (const auto& [id, channel] : recording.channels()) {
    auto& told = *channels.add_values()->mutable_struct_value()->mutable_fields();
    const std::uint64_t messages = messages_of(statistics, id);
    told["topic"] = json(channel.topic);
    told["schema"] = json(recording.schema_name(channel));
    told["messages"] = json(static_cast<double>(messages));
    told["rate_hz"] = json(rate_of(messages, seconds_of(statistics)));
  }
  auto& scenes = *fields["scenes"].mutable_list_value();
  for (const v1::SceneDescription& scene : contents.scenes) {
    auto& told = *scenes.add_values()->mutable_struct_value()->mutable_fields();
    told["name"] = json(scene.scene().name());
    told["revision"] = json(static_cast<double>(scene.revision()));
    told["objects"] = json(scene.scene().object_size());
    told["fingers"] = json(scene.scene().finger_size());
  }
  auto& attachments = *fields["attachments"].mutable_list_value();
  for (const recording::AttachmentIndex& attachment : recording.attachments()) {
    auto& told = *attachments.add_values()->mutable_struct_value()->mutable_fields();
    told["name"] = json(attachment.name);
    told["bytes"] = json(static_cast<double>(attachment.data_size));
  }
  print_json(info);
}

void line(const char* what, const std::string& value) { fmt::print("{:<12} {}\n", what, value); }

void print_info(std::uint64_t size, const Recording& recording, const recording::Metadata& session,
                const Contents& contents) {
  const recording::Statistics& statistics = recording.statistics();
  const double seconds = seconds_of(statistics);
  line("made by", recording.header().library.empty() ? "unknown" : recording.header().library);
  if (const auto version = session.metadata.find("daemon_version"); version != session.metadata.end()) {
    line("daemon", "hapticd " + version->second);
  }
  line("size", bytes(size));
  line("whole", recording.damage().empty() ? "yes" : "NO: " + recording.damage() + "; hapticctl recover");
  line("start", moment(statistics.start_time));
  line("duration", fmt::format("{:.3f} s", seconds));
  for (const v1::SceneDescription& scene : contents.scenes) {
    line("scene",
         fmt::format("{} (revision {}): {}, {}",
                     scene.scene().name().empty() ? "without a name" : scene.scene().name(), scene.revision(),
                     count_of(static_cast<std::uint64_t>(scene.scene().object_size()), "object"),
                     count_of(static_cast<std::uint64_t>(scene.scene().finger_size()), "finger")));
  }
  line("gaps", contents.gaps == 0
                   ? "none"
                   : fmt::format("{}: {} lost", contents.gaps, count_of(contents.lost_frames, "frame")));
  line("replay", replay_of(contents));
  for (const recording::AttachmentIndex& attachment : recording.attachments()) {
    line("attachment", attachment.name + ", " + bytes(attachment.data_size));
  }
  Table table({{"topic", Align::kLeft}, {"schema", Align::kLeft}, {"messages"}, {"Hz"}});
  for (const auto& [id, channel] : recording.channels()) {
    const std::uint64_t messages = messages_of(statistics, id);
    const double rate = rate_of(messages, seconds);
    table.add({channel.topic, recording.schema_name(channel), fmt::format("{}", messages),
               rate > 0.0 ? fmt::format("{:.1f}", rate) : "-"});
  }
  fmt::print("\n{}", table.to_string());
}

// what goes wrong with a file names it
template <class Do>
ExitCode with_file(const std::string& file, Do action) {
  try {
    return action();
  } catch (const recording::FormatError& error) {
    throw recording::FormatError(file + ": " + error.what());
  }
}

ExitCode show_info(Command& command, const std::string& file) {
  return with_file(file, [&] {
    const FileSource source(file);
    const Recording recording(source);
    const recording::Metadata session =
        recording.find_metadata(recording::kSessionMetadata).value_or(recording::Metadata{});
    const Contents contents = contents_of(recording);
    if (command.json) {
      print_info_json(file, source.size(), recording, session, contents);
    } else {
      print_info(source.size(), recording, session, contents);
    }
    return kDone;
  });
}

// takes a first look at what a recovery would find
class Nowhere : public recording::Sink {
 public:
  void write(std::string_view /*bytes*/) override {}
  void truncate(std::uint64_t /*size*/) override {}
  void sync() override {}
};

bool is_whole(const FileSource& source) {
  if (!Recording(source).damage().empty()) {
    return false;
  }
  Nowhere nowhere;
  recording::Writer writer(nowhere, {.library = "", .compress = false});
  return recording::recover(source, writer).damage.empty();
}

void print_recovered(const Command& command, const std::string& out, const recording::Recovered& result) {
  if (command.json) {
    google::protobuf::Struct told;
    auto& fields = *told.mutable_fields();
    fields["file"] = json(out);
    fields["damage"] = json(result.damage);
    fields["messages"] = json(static_cast<double>(result.messages));
    fields["attachments"] = json(static_cast<double>(result.attachments));
    fields["lost_chunks"] = json(static_cast<double>(result.lost_chunks));
    fields["lost_messages"] = json(static_cast<double>(result.lost_messages));
    fields["lost_records"] = json(static_cast<double>(result.lost_records));
    fields["lost_bytes"] = json(static_cast<double>(result.bytes_beyond));
    print_json(told);
    return;
  }
  fmt::print("{}: {} and {}\n", out, count_of(result.messages, "message"),
             count_of(result.attachments, "attachment"));
  fmt::print("the damage: {}\n", result.damage);
  if (result.lossless()) {
    fmt::print("nothing is lost\n");
    return;
  }
  fmt::print("lost: {}, {}, {}, {} at the end\n", count_of(result.lost_chunks, "chunk"),
             count_of(result.lost_messages, "message"), count_of(result.lost_records, "other record"),
             bytes(result.bytes_beyond));
}

ExitCode recover_file(Command& command, const std::string& file, const std::string& wanted) {
  return with_file(file, [&] {
    const FileSource source(file);
    if (is_whole(source)) {
      std::fprintf(stderr, "hapticctl: %s: is whole; there is nothing to recover\n", file.c_str());
      return kNothingToDo;
    }
    const std::string out =
        wanted.empty() ? std::filesystem::path(file).replace_extension(".recovered.mcap").string() : wanted;
    FileSink sink(out, FileSink::IfThere::kRefuse, FileSink::Durable::kYes);
    recording::Writer writer(sink, {.library = recording::library_of(source)});
    const recording::Recovered result = recording::recover(source, writer);
    sink.close();
    print_recovered(command, out, result);
    return kDone;
  });
}

}  // namespace

void add_recording(CLI::App& app, Command& command) {
  const auto info = std::make_shared<std::string>();
  CLI::App& tell = add_verb(app, command, "info", "what is in a recording, and whether it is whole",
                            [info](Command& chosen) { return show_info(chosen, *info); });
  add_option(tell, "file", *info, "the recording").required().type("FILE");
  const auto broken = std::make_shared<std::string>();
  const auto out = std::make_shared<std::string>();
  CLI::App& recover =
      add_verb(app, command, "recover", "makes a whole recording of one that was cut off or is damaged",
               [broken, out](Command& chosen) { return recover_file(chosen, *broken, *out); });
  add_option(recover, "file", *broken, "the recording; it is left as it is").required().type("FILE");
  add_option(recover, "-o,--output", *out, "the new one; default: beside it, .recovered.mcap").type("FILE");
}

}  // namespace haptic::cli
