#include "proto/metrics/exposition.h"

#include <gtest/gtest.h>

namespace haptic::metrics {
namespace {

bool has_line(const std::string& text, const std::string& line) {
  return ("\n" + text).find("\n" + line + "\n") != std::string::npos;
}

std::string page_of(const v1::Status& status) {
  return exposition({.status = status, .devices = {}, .stats = {}, .faults = std::nullopt});
}

TEST(Exposition, TellsWhatEachNumberMeansOnceBeforeIt) {
  v1::Status status;
  status.set_clients(3);
  EXPECT_NE(page_of(status).find("# HELP hapticd_clients Clients that are connected.\n"
                                 "# TYPE hapticd_clients gauge\n"
                                 "hapticd_clients 3\n"),
            std::string::npos);
}

TEST(Exposition, TellsLargeCountsToTheLastDigit) {
  v1::Status status;
  status.set_tick(9'007'199'254'740'993);  // 2^53 + 1, which is no double
  EXPECT_TRUE(has_line(page_of(status), "hapticd_ticks_total 9007199254740993"));
}

TEST(Exposition, EscapesNamesThatPeopleChose) {
  v1::Status status;
  status.set_version("1.0");
  status.set_scene("a \"b\" \\ c\nd");
  EXPECT_TRUE(has_line(page_of(status), R"(hapticd_info{version="1.0",scene="a \"b\" \\ c\nd"} 1)"));
}

// bounds at 1023 ns and 2047 ns; the bin from 1024 to 1087 ns lies between them
TEST(Exposition, AddsTheBinsOfAHistogramUp) {
  v1::Stats stats;
  v1::Histogram& wakeup = *stats.mutable_wakeup();
  for (const auto& [upper, count] : {std::pair{15U, 4U}, std::pair{1023U, 2U}, std::pair{1087U, 1U}}) {
    wakeup.add_upper_ns(upper);
    wakeup.add_count(count);
  }
  wakeup.set_total(8);  // one beyond them all
  wakeup.set_mean_ns(250.0);
  const std::string page = exposition({.status = {}, .devices = {}, .stats = stats, .faults = std::nullopt});
  EXPECT_TRUE(has_line(page, "hapticd_wakeup_lateness_seconds_bucket{le=\"1.023e-06\"} 6")) << page;
  EXPECT_TRUE(has_line(page, "hapticd_wakeup_lateness_seconds_bucket{le=\"2.047e-06\"} 7")) << page;
  EXPECT_TRUE(has_line(page, "hapticd_wakeup_lateness_seconds_bucket{le=\"+Inf\"} 8")) << page;
  EXPECT_TRUE(has_line(page, "hapticd_wakeup_lateness_seconds_count 8")) << page;
  EXPECT_TRUE(has_line(page, "hapticd_wakeup_lateness_seconds_sum 2e-06")) << page;
}

TEST(Exposition, CountsDevicesByPhaseAndTellsOfEach) {
  v1::DeviceList devices;
  v1::DeviceStatus& device = *devices.add_device();
  device.mutable_description()->set_name("left");
  device.mutable_description()->set_driver("falcon");
  device.set_phase(v1::DEVICE_READY);
  device.set_sample_age(0.0015);
  device.mutable_wrench()->mutable_force()->set_x(3.0);
  device.mutable_wrench()->mutable_force()->set_y(-4.0);
  const std::string page =
      exposition({.status = {}, .devices = devices, .stats = {}, .faults = std::nullopt});
  EXPECT_TRUE(has_line(page, "hapticd_devices{phase=\"ready\"} 1"));
  EXPECT_TRUE(has_line(page, "hapticd_devices{phase=\"absent\"} 0"));
  EXPECT_TRUE(has_line(page, "hapticd_device_sample_age_seconds{device=\"left\",driver=\"falcon\"} 0.0015"));
  EXPECT_TRUE(has_line(page, "hapticd_device_force_newtons{device=\"left\",driver=\"falcon\"} 5"));
}

TEST(Exposition, CountsFaultsOnlyWhereAllAreKnown) {
  v1::FaultList list;
  list.add_fault()->mutable_fault()->set_kind(v1::FAULT_OVER_SPEED);
  list.add_fault()->mutable_fault()->set_kind(v1::FAULT_OVER_SPEED);
  const std::string known =
      exposition({.status = {}, .devices = {}, .stats = {}, .faults = count_faults(list, 3)});
  EXPECT_TRUE(has_line(known, "hapticd_faults_total{kind=\"over_speed\"} 2"));
  EXPECT_TRUE(has_line(known, "hapticd_faults_total{kind=\"lost_driver\"} 0"));
  EXPECT_EQ(count_faults(list, 2), std::nullopt) << "older ones may have been dropped";
  EXPECT_EQ(page_of({}).find("hapticd_faults_total"), std::string::npos);
}

}  // namespace
}  // namespace haptic::metrics
