#include "client/export/export.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <system_error>

#include "client/export/csv_table.h"
#include "client/export/hdf5_table.h"
#include "proto/recording/error.h"
#include "proto/recording/session.h"

namespace haptic::exporting {
namespace {

using recording::Recording;

constexpr Topic kTopics[] = {Topic::kHips,   Topic::kObjects, Topic::kDevices, Topic::kContacts,
                             Topic::kEvents, Topic::kStats,   Topic::kGaps};

std::optional<recording::Metadata> session_of(const Recording& recording) {
  return recording.find_metadata(recording::kSessionMetadata);
}

double rate_of(const std::optional<recording::Metadata>& session) {
  double rate_hz = 0.0;
  if (session) {
    const auto found = session->metadata.find("rate_hz");
    if (found != session->metadata.end()) {
      std::from_chars(found->second.data(), found->second.data() + found->second.size(), rate_hz);
    }
  }
  if (!std::isfinite(rate_hz) || rate_hz <= 0.0) {
    throw recording::FormatError(
        "the recording does not tell the rate of its ticks; hapticd has not made it");
  }
  return rate_hz;
}

// hands everything on, and counts rows
class Counted : public TableWriter {
 public:
  explicit Counted(std::unique_ptr<TableWriter> table) : table_(std::move(table)) {}
  void add(std::uint64_t count) override { table_->add(count); }
  void add(double number) override { table_->add(number); }
  void add(bool flag) override { table_->add(flag); }
  void add(std::string_view text) override { table_->add(text); }
  void end_row() override {
    table_->end_row();
    ++rows_;
  }
  void close() override { table_->close(); }
  std::uint64_t rows() const noexcept { return rows_; }

 private:
  std::unique_ptr<TableWriter> table_;
  std::uint64_t rows_ = 0;
};

std::uint64_t add_capped(std::uint64_t start, std::uint64_t offset) {
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();
  return offset > kMost - start ? kMost : start + offset;
}

// one pass for each topic: chunks without it are not read
std::uint64_t fill(const Recording& recording, const Plan& plan, Topic topic, const Naming& naming,
                   std::unique_ptr<TableWriter> writer) {
  const std::uint64_t start = recording.statistics().start_time;
  Counted table(std::move(writer));
  auto messages = recording.messages({.topics = {channel_of(topic)},
                                      .from = add_capped(start, plan.from_ns),
                                      .to = add_capped(start, plan.to_ns)});
  v1::Frame frame;
  v1::Gap gap;
  while (messages.next()) {
    if (topic == Topic::kGaps) {
      messages.parse(gap);
      add_row(gap, table);
    } else {
      messages.parse(frame);
      add_rows(topic, frame, naming, table);
    }
  }
  table.close();
  return table.rows();
}

// takes the place of the file when it is whole; else it goes
class Draft {
 public:
  explicit Draft(const std::string& file) : file_(file), name_(file + ".part") {}
  ~Draft() {
    std::error_code ignored;
    std::filesystem::remove(name_, ignored);
  }
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;

  const std::string& name() const noexcept { return name_; }

  void keep() const {
    std::error_code error;
    std::filesystem::rename(name_, file_, error);
    if (error) {
      throw csv::OutputError(file_ + ": cannot be written: " + error.message());
    }
  }

 private:
  std::string file_;
  std::string name_;
};

void describe(const recording::Metadata& session, double rate_hz, Hdf5File& file) {
  for (const auto& [name, text] : session.metadata) {
    if (name != "rate_hz") {
      file.describe(name, text);
    }
  }
  file.describe("rate_hz", rate_hz);
  file.describe("conventions",
                "SI units, right-handed frames, quaternions w x y z; tick n is at time n / rate_hz");
}

}  // namespace

std::string channel_of(Topic topic) {
  switch (topic) {
    case Topic::kHips:
    case Topic::kContacts:
      return recording::channel_of(v1::HIPS);
    case Topic::kObjects:
      return recording::channel_of(v1::OBJECTS);
    case Topic::kDevices:
      return recording::channel_of(v1::DEVICES);
    case Topic::kEvents:
      return recording::channel_of(v1::EVENTS);
    case Topic::kStats:
      return recording::channel_of(v1::STATS);
    case Topic::kGaps:
      break;
  }
  return recording::kGapsTopic;
}

Naming naming_of(const Recording& recording) {
  Naming naming;
  naming.rate_hz = rate_of(session_of(recording));
  for (auto messages = recording.messages({.topics = {recording::kSceneTopic}}); messages.next();) {
    v1::SceneDescription scene;
    messages.parse(scene);
    naming.scenes[scene.revision()] = std::move(scene);
  }
  v1::DeviceList devices;
  if (auto messages = recording.messages({.topics = {recording::kDevicesTopic}}); messages.next()) {
    messages.parse(devices);
  }
  for (const v1::DeviceStatus& device : devices.device()) {
    naming.devices.push_back(device.description().name());
  }
  return naming;
}

std::vector<Topic> topics_in(const Recording& recording) {
  std::vector<Topic> topics;
  for (const Topic topic : kTopics) {
    const auto is_it = [&](const auto& entry) { return entry.second.topic == channel_of(topic); };
    if (std::any_of(recording.channels().begin(), recording.channels().end(), is_it)) {
      topics.push_back(topic);
    }
  }
  return topics;
}

std::vector<std::pair<Topic, std::uint64_t>> export_tables(const Recording& recording, const Plan& plan) {
  const std::vector<Topic> available = topics_in(recording);
  for (const Topic topic : plan.topics) {
    if (std::find(available.begin(), available.end(), topic) == available.end()) {
      throw Missing("the recording has no " + std::string(name_of(topic)));
    }
  }
  const std::vector<Topic>& topics = plan.topics.empty() ? available : plan.topics;
  const std::optional<recording::Metadata> session = session_of(recording);
  const Naming naming = naming_of(recording);

  std::vector<std::pair<Topic, std::uint64_t>> rows;
  const Draft draft(plan.file);
  if (plan.format == Format::kCsv) {
    const Topic topic = topics.at(0);
    rows.emplace_back(topic, fill(recording, plan, topic, naming,
                                  std::make_unique<CsvTable>(draft.name(), columns_of(topic))));
  } else {
    Hdf5File file(draft.name());
    describe(*session, naming.rate_hz, file);
    for (const Topic topic : topics) {
      rows.emplace_back(topic, fill(recording, plan, topic, naming,
                                    file.add_table(std::string(name_of(topic)), columns_of(topic))));
    }
    file.close();
  }
  draft.keep();
  return rows;
}

}  // namespace haptic::exporting
