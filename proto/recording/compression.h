#pragma once
// The bytes of a chunk: zstd or none. LZ4, which the format has, too, is refused.

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

struct ZSTD_CCtx_s;

namespace haptic::recording {

/// No larger chunk is read, whatever it says of itself.
inline constexpr std::uint64_t kLargestChunk = std::uint64_t{256} << 20;

/// One zstd frame for each call, at the fastest level.
class Compressor {
 public:
  Compressor();

  /// Valid until the next call. Empty if it would hardly be smaller than `bytes`: then leave them as they
  /// are.
  std::string_view compress(std::string_view bytes);

 private:
  struct Free {
    void operator()(ZSTD_CCtx_s* context) const noexcept;
  };
  std::unique_ptr<ZSTD_CCtx_s, Free> context_;
  std::string out_;
};

/// The bytes of which `compressed` was made. Throws FormatError unless they are `size` many and at most
/// kLargestChunk. Memory grows with what is really there, not with what `size` claims.
std::string decompress(std::string_view compression, std::string_view compressed, std::uint64_t size);

}  // namespace haptic::recording
