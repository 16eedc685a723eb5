#pragma once
// The machine that emulated devices are plugged into: umockdev shows the process another /sys and /dev. The
// process must run under umockdev's preload library (haptic_mocked_test in CMake). Make the bus before
// anything looks for devices.

#include <umockdev.h>

#include <set>
#include <stdexcept>
#include <string>

namespace haptic::test {

class MockBus {
 public:
  MockBus() : testbed_(umockdev_testbed_new()) {
    // only asked now: the answer is remembered for ever
    if (!umockdev_in_mock_environment()) {
      g_object_unref(testbed_);
      throw std::runtime_error("this test needs umockdev's preload library");
    }
  }
  ~MockBus() { g_object_unref(testbed_); }
  MockBus(const MockBus&) = delete;
  MockBus& operator=(const MockBus&) = delete;

  UMockdevTestbed* testbed() const { return testbed_; }

  /// Where "/dev/..." really is.
  std::string real_path(const std::string& node) const {
    char* const root = umockdev_testbed_get_root_dir(testbed_);
    const std::string path = root + node;
    g_free(root);
    return path;
  }

  /// Adds devices as umockdev writes them.
  void add(const std::string& text) const {
    GError* error = nullptr;
    if (umockdev_testbed_add_from_string(testbed_, text.c_str(), &error)) return;
    const std::string message = error->message;
    g_error_free(error);
    throw std::runtime_error(message);
  }

  /// The same for what several devices share, and only the first adds.
  void add_once(const std::string& path, const std::string& text) {
    if (shared_.insert(path).second) add(text);
  }

  /// Lets `handler` answer for the node.
  void attach(const std::string& node, UMockdevIoctlBase* handler) const {
    GError* error = nullptr;
    if (umockdev_testbed_attach_ioctl(testbed_, node.c_str(), handler, &error)) return;
    const std::string message = error->message;
    g_error_free(error);
    throw std::runtime_error(message);
  }

 private:
  UMockdevTestbed* testbed_;
  std::set<std::string> shared_;
};

}  // namespace haptic::test
