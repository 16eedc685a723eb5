// The doctor on machines that are made of a few files in a temporary folder.

#include "client/doctor/doctor.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "client/doctor/checks.h"
#include "client/doctor/usb.h"
#include "tests/support/temporary_folder.h"

namespace haptic::doctor {
namespace {

class Doctor : public testing::Test {
 protected:
  Doctor() {
    write("/etc/passwd", "root:x:0:0::/root:/bin/sh\nlab:x:4242:4242::/home/lab:/bin/sh\n");
    write("/etc/group", "plugdev:x:46:ada,lab\nlab:x:4242:\n");
  }

  std::filesystem::path at(const std::string& path) const { return folder.file("") + path; }

  void write(const std::string& path, const std::string& text) const {
    std::filesystem::create_directories(at(path).parent_path());
    std::ofstream(at(path), std::ios::binary) << text;
  }
  void link(const std::string& path, const std::string& target) const {
    std::filesystem::create_directories(at(path).parent_path());
    std::filesystem::create_symlink(target, at(path));
  }
  /// A node that nobody but its owner may use; `mode` as of chmod.
  void node(const std::string& path, mode_t mode) const {
    write(path, "");
    ::chmod(at(path).c_str(), mode);
  }
  void process(int pid, const std::string& program) const {
    write("/proc/" + std::to_string(pid) + "/comm", program + "\n");
  }

  /// Somebody who is neither the owner of the files here nor in their group.
  Machine machine() const { return {folder.file(""), {"lab", 4242, {4242, 46}}, false}; }

  void falcon(const std::string& port, const std::string& serial = "") const {
    const std::string sys = "/sys/bus/usb/devices/" + port;
    write(sys + "/idVendor", "0403\n");
    write(sys + "/idProduct", "cb48\n");
    write(sys + "/busnum", "1\n");
    write(sys + "/devnum", "5\n");
    write(sys + "/speed", "12\n");
    if (!serial.empty()) write(sys + "/serial", serial + "\n");
  }

  Findings real_time(const v1::Servo& servo = {}) const {
    Findings findings;
    check_real_time(machine(), servo, findings);
    return findings;
  }
  Findings device(const std::string& text) const {
    v1::DaemonConfig config = read_config(folder.write("c.txtpb", "device { name: \"hand\" " + text + " }"));
    Findings findings;
    check_device(machine(), config.device(0), findings);
    return findings;
  }

  test::TemporaryFolder folder;
};

/// The first finding about it whose reason has these words; one that is empty if there is none.
Finding find(const Findings& findings, const std::string& about, const std::string& words = "") {
  const auto found = std::find_if(findings.begin(), findings.end(), [&](const Finding& finding) {
    return finding.about == about && finding.reason.find(words) != std::string::npos;
  });
  if (found != findings.end()) return *found;
  ADD_FAILURE() << "nothing about " << about << " with: " << words;
  return {};
}

bool has(const Findings& findings, const std::string& words) {
  return std::any_of(findings.begin(), findings.end(), [&](const Finding& finding) {
    return (finding.reason + finding.command).find(words) != std::string::npos;
  });
}

TEST(DoctorNumbers, AreThoseOfAKernelsList) {
  EXPECT_EQ(numbers_of("0-3,8"), (std::vector<unsigned>{0, 1, 2, 3, 8}));
  EXPECT_EQ(numbers_of(" 5\n"), (std::vector<unsigned>{5}));
  EXPECT_EQ(numbers_of(""), std::vector<unsigned>{});
  EXPECT_EQ(numbers_of("x,1-,-2,7"), (std::vector<unsigned>{7}));
  EXPECT_LE(numbers_of("0-4294967295").size(), 4096U);
}

TEST(DoctorVerdicts, TheWorstIsThatOfAll) {
  EXPECT_EQ(worst({}), Verdict::kOk);
  EXPECT_EQ(worst({{"a", Verdict::kNote, ""}, {"b", Verdict::kBad, ""}, {"c", Verdict::kWarning, ""}}),
            Verdict::kBad);
}

TEST_F(Doctor, AnEmptyMachineIsNoError) {
  const Findings findings = examine(machine(), std::nullopt);
  EXPECT_LE(worst(findings), Verdict::kWarning);
  EXPECT_EQ(find(findings, "devices").verdict, Verdict::kNote);
}

TEST_F(Doctor, KnowsKernelsByWhatTheySay) {
  EXPECT_EQ(find(real_time(), "kernel").verdict, Verdict::kNote);
  write("/proc/cmdline", "quiet preempt=full\n");
  EXPECT_NE(find(real_time(), "kernel").reason.find("preempt=full"), std::string::npos);
  write("/sys/kernel/realtime", "1\n");
  EXPECT_EQ(find(real_time(), "kernel").verdict, Verdict::kOk);
}

TEST_F(Doctor, ComparesTheLimitWithThePriorityThatIsWanted) {
  write("/proc/self/limits",
        "Limit                     Soft Limit           Hard Limit           Units     \n"
        "Max locked memory         8388608              8388608              bytes     \n"
        "Max realtime priority     70                   95                             \n");
  v1::Servo servo;
  servo.set_priority(70);
  EXPECT_EQ(find(real_time(servo), "priority").verdict, Verdict::kOk);
  servo.set_priority(71);
  const Finding refused = find(real_time(servo), "priority");
  EXPECT_EQ(refused.verdict, Verdict::kWarning);
  EXPECT_EQ(refused.command,
            "echo '" + std::string("lab") + " - rtprio 95' | sudo tee /etc/security/limits.d/hapticd.conf");
  EXPECT_NE(find(real_time(), "memory").reason.find("8192 KiB"), std::string::npos);
  EXPECT_EQ(find(real_time(), "memory").verdict, Verdict::kNote);
  servo.set_lock_memory(true);
  EXPECT_EQ(find(real_time(servo), "memory").verdict, Verdict::kWarning);
}

TEST_F(Doctor, TheLimitsAreThoseOfTheDaemonThatRuns) {
  process(77, "hapticd");
  write("/proc/self/limits", "Max realtime priority     0  0\nMax locked memory   0 0 bytes\n");
  write("/proc/77/limits",
        "Max realtime priority     99 99\nMax locked memory   unlimited unlimited bytes\n");
  EXPECT_EQ(find(real_time(), "priority").verdict, Verdict::kOk);
  EXPECT_EQ(find(real_time(), "memory").verdict, Verdict::kOk);
}

TEST_F(Doctor, TellsHowMuchOfACoreRealTimeThreadsMayHave) {
  const auto verdict_of = [&](const std::string& runtime) {
    write("/proc/sys/kernel/sched_rt_runtime_us", runtime);
    write("/proc/sys/kernel/sched_rt_period_us", "1000000\n");
    return find(real_time(), "throttling").verdict;
  };
  EXPECT_EQ(verdict_of("950000\n"), Verdict::kOk);
  EXPECT_EQ(verdict_of("499999\n"), Verdict::kWarning);
  EXPECT_EQ(verdict_of("-1\n"), Verdict::kNote);
  EXPECT_EQ(verdict_of("0\n"), Verdict::kBad);
}

TEST_F(Doctor, AGroupWithoutRealTimeIsBadAndOneWithALimitIsAWarning) {
  EXPECT_EQ(find(real_time(), "cgroup").verdict, Verdict::kOk);
  write("/proc/self/cgroup", "3:cpu,cpuacct:/user.slice\n0::/lab\n");
  write("/sys/fs/cgroup/lab/cpu.max", "max 100000\n");
  EXPECT_EQ(find(real_time(), "cgroup").verdict, Verdict::kOk);
  write("/sys/fs/cgroup/lab/cpu.max", "20000 100000\n");
  EXPECT_EQ(find(real_time(), "cgroup").verdict, Verdict::kWarning);
  write("/sys/fs/cgroup/cpu,cpuacct/user.slice/cpu.rt_runtime_us", "0\n");
  const Finding none = find(real_time(), "cgroup");
  EXPECT_EQ(none.verdict, Verdict::kBad);
  EXPECT_EQ(none.command, "echo 950000 | sudo tee /sys/fs/cgroup/cpu,cpuacct/user.slice/cpu.rt_runtime_us");
}

TEST_F(Doctor, AClockThatIsSlowToReadIsAWarning) {
  const std::string clocks = "/sys/devices/system/clocksource/clocksource0/";
  write(clocks + "current_clocksource", "tsc\n");
  EXPECT_EQ(find(real_time(), "clock").verdict, Verdict::kOk);
  write(clocks + "current_clocksource", "hpet\n");
  EXPECT_EQ(find(real_time(), "clock").command, "") << "there is no other";
  write(clocks + "available_clocksource", "tsc hpet acpi_pm\n");
  EXPECT_EQ(find(real_time(), "clock").verdict, Verdict::kWarning);
  EXPECT_EQ(find(real_time(), "clock").command, "echo tsc | sudo tee " + clocks + "current_clocksource");
}

TEST_F(Doctor, OnlyTheServosOwnCoreNeedsTheGovernor) {
  write("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "powersave\n");
  write("/sys/devices/system/cpu/cpu1/cpufreq/scaling_governor", "performance\n");
  write("/sys/devices/system/cpu/cpufreq/unrelated", "");
  const Finding all = find(real_time(), "governor");
  EXPECT_EQ(all.verdict, Verdict::kWarning);
  EXPECT_NE(all.reason.find("cpu0 powersave"), std::string::npos);
  v1::Servo servo;
  servo.set_cpu(1);
  EXPECT_EQ(find(real_time(servo), "governor").verdict, Verdict::kOk);
}

TEST_F(Doctor, DeepSleepIsAWarningUnlessTheDaemonCanPreventIt) {
  const std::string state = "/sys/devices/system/cpu/cpu0/cpuidle/state3/";
  write(state + "name", "C10\n");
  write(state + "latency", "890\n");
  node("/dev/cpu_dma_latency", 0600);
  const Finding refused = find(real_time(), "sleep");
  EXPECT_EQ(refused.verdict, Verdict::kWarning);
  EXPECT_NE(refused.reason.find("890 us to wake from C10"), std::string::npos);
  ::chmod(at("/dev/cpu_dma_latency").c_str(), 0666);
  EXPECT_EQ(find(real_time(), "sleep").verdict, Verdict::kOk);
  ::chmod(at("/dev/cpu_dma_latency").c_str(), 0600);
  write(state + "disable", "1\n");
  EXPECT_EQ(find(real_time(), "sleep").verdict, Verdict::kOk);
}

TEST_F(Doctor, TheServosCoreShouldExistAndBeItsOwn) {
  v1::Servo servo;
  servo.set_cpu(3);
  write("/sys/devices/system/cpu/online", "0-2\n");
  EXPECT_EQ(find(real_time(servo), "core").verdict, Verdict::kBad);
  write("/sys/devices/system/cpu/online", "0-3\n");
  write("/sys/devices/system/cpu/isolated", "\n");
  EXPECT_EQ(find(real_time(servo), "core").verdict, Verdict::kNote);
  write("/sys/devices/system/cpu/isolated", "2-3\n");
  EXPECT_EQ(find(real_time(servo), "core").verdict, Verdict::kOk);
}

TEST_F(Doctor, TellsWhichInterruptsDisturbTheServosCore) {
  v1::Servo servo;
  servo.set_cpu(3);
  write("/proc/irq/16/effective_affinity_list", "0-2\n");
  EXPECT_EQ(find(real_time(servo), "interrupts").verdict, Verdict::kOk);
  write("/proc/irq/24/effective_affinity_list", "3\n");
  EXPECT_NE(find(real_time(servo), "interrupts").reason.find("core 3: 24"), std::string::npos);
  process(9, "irqbalance");
  EXPECT_TRUE(has(real_time(servo), "IRQBALANCE_BANNED_CPULIST=3"));
}

TEST_F(Doctor, AFalconThatIsNotThereIsBad) {
  const Finding finding = find(device("falcon {}"), "device hand");
  EXPECT_EQ(finding.verdict, Verdict::kBad);
  EXPECT_EQ(finding.command, "lsusb -d 0403:cb48");
}

TEST_F(Doctor, AFalconThatMayBeOpenedIsFine) {
  falcon("1-2");
  node("/dev/bus/usb/001/005", 0666);
  const Findings findings = device("falcon {}");
  EXPECT_EQ(worst(findings), Verdict::kOk);
  EXPECT_EQ(find(findings, "device hand").reason, "Novint Falcon at /dev/bus/usb/001/005, 12 Mbit/s");
}

TEST_F(Doctor, ANodeThatNobodyMayOpenNeedsTheRules) {
  falcon("1-2");
  node("/dev/bus/usb/001/005", 0600);
  const Finding finding = find(device("falcon {}"), "device hand");
  EXPECT_EQ(finding.verdict, Verdict::kBad);
  EXPECT_NE(finding.reason.find("rw-------) may not be opened by"), std::string::npos) << finding.reason;
  EXPECT_NE(finding.command.find("70-hapticd.rules"), std::string::npos);
}

TEST_F(Doctor, ANodeOfAGroupNeedsAMember) {
  if (::chown(folder.file("").c_str(), 0, 46) != 0)
    GTEST_SKIP() << "only root can make a node of another group";
  falcon("1-2");
  node("/dev/bus/usb/001/005", 0660);
  ASSERT_EQ(::chown(at("/dev/bus/usb/001/005").c_str(), 0, 46), 0);
  v1::Device config;
  config.set_name("hand");
  config.mutable_falcon();
  Findings findings;
  check_device({folder.file(""), {"lab", 4242, {4242}}, false}, config, findings);
  EXPECT_EQ(find(findings, "device hand").command, "sudo usermod -aG plugdev lab");
  findings.clear();
  check_device({folder.file(""), {"lab", 4242, {4242, 46}}, false}, config, findings);
  EXPECT_EQ(worst(findings), Verdict::kOk);
}

TEST_F(Doctor, TellsWhoHoldsADevice) {
  falcon("1-2");
  node("/dev/bus/usb/001/005", 0666);
  process(123, "falcon_test");
  link("/proc/123/fd/4", "/dev/bus/usb/001/005");
  const Finding held = find(device("falcon {}"), "device hand");
  EXPECT_EQ(held.verdict, Verdict::kBad);
  EXPECT_EQ(held.reason, "/dev/bus/usb/001/005 is held by falcon_test (process 123)");
  process(123, "hapticd");
  EXPECT_EQ(worst(device("falcon {}")), Verdict::kOk) << "the daemon itself is no stranger";
}

TEST_F(Doctor, TellsOfTheKernelsDriverSleepAndNeighbours) {
  falcon("1-2.1");
  node("/dev/bus/usb/001/005", 0666);
  link("/sys/bus/usb/devices/1-2.1:1.0/driver", "../../../../bus/usb/drivers/ftdi_sio");
  write("/sys/bus/usb/devices/1-2.1/power/control", "auto\n");
  const std::string camera = "/sys/bus/usb/devices/1-2.4";
  write(camera + "/idVendor", "046d\n");
  write(camera + "/idProduct", "082d\n");
  write(camera + "/busnum", "1\n");
  write(camera + "/devnum", "6\n");
  const Findings findings = device("falcon {}");
  EXPECT_EQ(find(findings, "device hand", "ftdi_sio").verdict, Verdict::kNote);
  EXPECT_EQ(find(findings, "device hand", "sleep").command,
            "echo on | sudo tee /sys/bus/usb/devices/1-2.1/power/control");
  EXPECT_NE(find(findings, "device hand", "hub at 1-2").reason.find("046d:082d"), std::string::npos);
}

TEST_F(Doctor, OfTwoFalconsTheConfigMustTellWhich) {
  falcon("1-2", "A");
  falcon("1-3", "B");
  node("/dev/bus/usb/001/005", 0666);
  EXPECT_EQ(find(device("falcon {}"), "device hand", "2 Falcons").verdict, Verdict::kBad);
  EXPECT_EQ(worst(device("falcon { serial: \"B\" }")), Verdict::kOk);
  EXPECT_EQ(worst(device("falcon { serial: \"C\" }")), Verdict::kBad);
}

TEST_F(Doctor, ASpaceMouseIsFoundByItsHidId) {
  write("/sys/class/hidraw/hidraw3/device/uevent",
        "DRIVER=hid-generic\nHID_ID=0003:0000046D:0000C626\nHID_UNIQ=S1\n");
  node("/dev/hidraw3", 0666);
  EXPECT_EQ(find(device("spacemouse {}"), "device hand").reason, "SpaceMouse (046d:c626) at /dev/hidraw3");
  EXPECT_EQ(worst(device("spacemouse { serial: \"S2\" }")), Verdict::kBad);
  EXPECT_EQ(worst(device("hydra {}")), Verdict::kBad);
  process(5, "spacenavd");
  EXPECT_EQ(find(device("spacemouse {}"), "device hand", "spacenavd").command,
            "sudo systemctl stop spacenavd");
}

TEST_F(Doctor, ASerialPortIsLookedAtThroughItsLink) {
  node("/dev/ttyUSB0", 0666);
  link("/dev/serial/by-id/fastrak", "../../ttyUSB0");
  write("/sys/bus/usb-serial/devices/ttyUSB0/latency_timer", "16\n");
  const Findings findings = device("fastrak { port: \"/dev/serial/by-id/fastrak\" }");
  const Finding timer = find(findings, "device hand", "16 ms");
  EXPECT_EQ(timer.verdict, Verdict::kWarning);
  EXPECT_EQ(timer.command, "echo 1 | sudo tee /sys/bus/usb-serial/devices/ttyUSB0/latency_timer");
  EXPECT_EQ(find(findings, "device hand", "FASTRAK at").verdict, Verdict::kOk);
  write("/sys/bus/usb-serial/devices/ttyUSB0/latency_timer", "1\n");
  EXPECT_EQ(worst(device("haply { port: \"/dev/ttyUSB0\" }")), Verdict::kOk);
  process(8, "ModemManager");
  EXPECT_EQ(worst(device("haply { port: \"/dev/ttyUSB0\" }")), Verdict::kWarning);
  EXPECT_EQ(worst(device("haply { port: \"/dev/ttyUSB1\" }")), Verdict::kBad);
}

TEST_F(Doctor, APhantomNeedsTheModuleTheNodeAndACalibration) {
  EXPECT_EQ(find(device("phantom { path: \"/dev/phantom0\" }"), "device hand").command,
            "sudo modprobe phantom");
  write("/sys/module/phantom/refcnt", "0\n");
  EXPECT_NE(find(device("phantom { path: \"/dev/phantom0\" }"), "device hand").command.find("lspci"),
            std::string::npos);
  node("/dev/phantom0", 0666);
  EXPECT_EQ(find(device("phantom { path: \"/dev/phantom0\" }"), "device hand", "calibration").verdict,
            Verdict::kNote);
  EXPECT_EQ(find(device("phantom { path: \"/dev/phantom0\" calibration: \"/none\" }"), "device hand",
                 "/none is not")
                .verdict,
            Verdict::kBad);
}

TEST_F(Doctor, FilesOfADeviceMustBeReadable) {
  write("/lab/left.csv", "time,x,y,z\n");
  const std::string playback = "playback { path: \"/lab/left.csv\" }";
  EXPECT_EQ(find(device(playback), "device hand").verdict, Verdict::kOk);
  ::chmod(at("/lab/left.csv").c_str(), 0600);
  EXPECT_EQ(find(device(playback), "device hand").command, "sudo chmod a+r /lab/left.csv");
  EXPECT_EQ(worst(device("playback { path: \"/lab/right.csv\" }")), Verdict::kBad);
}

TEST_F(Doctor, AnExternalDeviceNeedsAFolderForItsSocket) {
  const std::string external = "external { path: \"/run/lab/a.sock\" }";
  EXPECT_EQ(find(device(external), "device hand").command,
            "sudo install -d -o " + std::string("lab") + " /run/lab");
  std::filesystem::create_directories(at("/run/lab"));
  ::chmod(at("/run/lab").c_str(), 0755);
  EXPECT_EQ(worst(device(external)), Verdict::kBad);
  ::chmod(at("/run/lab").c_str(), 0777);
  EXPECT_EQ(worst(device(external)), Verdict::kOk);
}

TEST_F(Doctor, WithoutAConfigItLooksAtWhatIsConnected) {
  falcon("1-2");
  node("/dev/bus/usb/001/005", 0600);
  write("/sys/class/hidraw/hidraw1/device/uevent", "HID_ID=0003:00001532:00000300\n");
  node("/dev/hidraw1", 0666);
  write("/sys/class/hidraw/hidraw2/device/uevent", "HID_ID=0003:0000046D:00000001\n");
  const Findings findings = examine(machine(), std::nullopt);
  EXPECT_EQ(find(findings, "usb 1-2").verdict, Verdict::kBad);
  EXPECT_EQ(find(findings, "hidraw1").reason, "Razer Hydra (1532:0300) at /dev/hidraw1");
  EXPECT_FALSE(has(findings, "hidraw2")) << "a mouse of no interest";
}

TEST_F(Doctor, LooksAtWhereTheDaemonListens) {
  v1::DaemonConfig config;
  config.add_listen()->mutable_unix()->set_path("/run/lab/h.sock");
  const auto socket = [&] {
    Findings findings;
    check_sockets(machine(), config, findings);
    return find(findings, "socket");
  };
  EXPECT_EQ(socket().verdict, Verdict::kBad);
  std::filesystem::create_directories(at("/run/lab"));
  ::chmod(at("/run/lab").c_str(), 0777);
  EXPECT_EQ(socket().verdict, Verdict::kOk);
  write("/run/lab/h.sock", "");
  EXPECT_EQ(socket().verdict, Verdict::kNote) << "left by a daemon that is gone";
  process(7, "hapticd");
  EXPECT_EQ(socket().verdict, Verdict::kOk);
}

TEST_F(Doctor, FindsTheConfigOfTheDaemonThatRuns) {
  EXPECT_EQ(find_config(machine()), "");
  write("/etc/hapticd/hapticd.txtpb", "");
  EXPECT_EQ(find_config(machine()), "/etc/hapticd/hapticd.txtpb");
  process(31, "hapticd");
  link("/proc/31/cwd", "/home/lab");
  write("/proc/31/cmdline", std::string("hapticd\0run\0--config\0demo.txtpb\0", 32));
  EXPECT_EQ(find_config(machine()), "/home/lab/demo.txtpb");
  write("/proc/31/cmdline", std::string("hapticd\0run\0--config=/a/b.txtpb\0", 32));
  EXPECT_EQ(find_config(machine()), "/a/b.txtpb");
}

TEST_F(Doctor, ReadsAConfigWithItsPathsMadeAbsolute) {
  const v1::DaemonConfig config = read_config(folder.write(
      "c.txtpb",
      "device { name: \"a\" falcon { firmware: \"f.bin\" } } listen { unix { path: \"s.sock\" } }"));
  EXPECT_EQ(config.device(0).falcon().firmware(), folder.file("f.bin"));
  EXPECT_EQ(config.listen(0).unix().path(), folder.file("s.sock"));
  EXPECT_EQ(read_config(folder.write("c.json", "{\"device\":[{\"name\":\"a\"}]}")).device(0).name(), "a");
  EXPECT_EQ(read_config(folder.write("empty.txtpb", "")).device_size(), 0);
}

TEST_F(Doctor, TellsWhereAConfigIsWrong) {
  const auto error_of = [](const std::string& file) -> std::string {
    try {
      read_config(file);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  };
  const std::string file = folder.write("c.txtpb", "servo {}\ndevise {}\n");
  EXPECT_TRUE(error_of(file).starts_with(file + ":2:")) << error_of(file);
  EXPECT_EQ(error_of("/nowhere/c.txtpb"), "/nowhere/c.txtpb: cannot be read");
  EXPECT_EQ(error_of(folder.file("")), folder.file("") + ": cannot be read");
  EXPECT_NE(error_of(folder.write("c.json", "{")), "");
}

TEST_F(Doctor, FindsAUserWithItsGroups) {
  const auto user = find_user(folder.file(""), "lab");
  ASSERT_TRUE(user);
  EXPECT_EQ(user->uid, 4242U);
  EXPECT_EQ(user->groups, (std::vector<gid_t>{4242, 46}));
  EXPECT_FALSE(find_user(folder.file(""), "nobody_here"));
}

}  // namespace
}  // namespace haptic::doctor
