// Hosts and URLs from a command line: a subject has only letters that a broker reads as such, and a URL that
// is shown has no user in it.

#include <algorithm>
#include <cstdlib>

#include "client/bridge/subject.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace haptic::bridge;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::string name = subject(text, "objects");
  if (std::count(name.begin(), name.end(), '.') != 2 || name.size() > 300) std::abort();
  if (name.find_first_of(std::string_view(" \t\r\n*>\0", 7)) != std::string::npos) std::abort();
  const std::string shown = without_secrets(text);
  if (shown.find('@') != std::string::npos && shown.find('@') > shown.find("://")) std::abort();
  if (url_problem(text).empty() && !url_problem(shown).empty()) std::abort();
  return 0;
}
