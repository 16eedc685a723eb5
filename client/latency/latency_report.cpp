#include "client/latency/latency_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace haptic::latency {

std::string in_words(double nanoseconds) {
  if (nanoseconds < 1e3) return fmt::format("{:.0f} ns", nanoseconds);
  if (nanoseconds < 1e6) return fmt::format("{:.1f} us", nanoseconds * 1e-3);
  return fmt::format("{:.2f} ms", nanoseconds * 1e-6);
}

std::string draw(const Latenesses& times, std::size_t width) {
  const auto& bins = times.bins();
  const auto counts_any = [](std::uint64_t count) { return count > 0; };
  const auto first = std::find_if(bins.begin(), bins.end(), counts_any);
  const auto last = std::find_if(bins.rbegin(), bins.rend(), counts_any).base();
  const double most = std::log1p(static_cast<double>(*std::max_element(bins.begin(), bins.end())));
  std::string text;
  for (auto bin = first; bin < last; ++bin) {
    const auto index = static_cast<std::size_t>(bin - bins.begin());
    const bool is_last = index == kBinEnds.size();
    const std::uint64_t end = kBinEnds[is_last ? index - 1 : index];
    const std::string name =
        end < 1'000'000 ? fmt::format("{} us", end / 1'000) : fmt::format("{} ms", end / 1'000'000);
    const double share = std::log1p(static_cast<double>(*bin)) / most;
    const auto length = static_cast<std::size_t>(std::lround(share * static_cast<double>(width)));
    text += fmt::format("{} {:>6} {:>9}  {}", is_last ? "> " : "<=", name, *bin, std::string(length, '#'));
    while (text.ends_with(' ')) text.pop_back();
    text += '\n';
  }
  return text;
}

}  // namespace haptic::latency
