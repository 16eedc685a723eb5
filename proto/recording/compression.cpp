#include "proto/recording/compression.h"

#include <zstd.h>

#include <new>

#include "proto/recording/error.h"

namespace haptic::recording {
namespace {

constexpr std::size_t kNotWorthIt = 1024;  // bytes
constexpr int kLevel = 1;                  // a recording must keep up with the servo thread on a busy machine
constexpr int kLargestWindowLog = 28;      // of kLargestChunk

struct FreeStream {
  void operator()(ZSTD_DCtx* stream) const noexcept { ZSTD_freeDCtx(stream); }
};

std::string decompress_zstd(std::string_view compressed, std::uint64_t size) {
  const std::unique_ptr<ZSTD_DCtx, FreeStream> stream(ZSTD_createDCtx());
  if (stream == nullptr) {
    throw std::bad_alloc();
  }
  ZSTD_DCtx_setParameter(stream.get(), ZSTD_d_windowLogMax, kLargestWindowLog);
  std::string out;
  std::string piece(ZSTD_DStreamOutSize(), '\0');
  ZSTD_inBuffer in{compressed.data(), compressed.size(), 0};
  std::size_t left = 1;  // 0 at the end of the frame
  while (left != 0) {
    ZSTD_outBuffer part{piece.data(), piece.size(), 0};
    const std::size_t before = in.pos;
    left = ZSTD_decompressStream(stream.get(), &part, &in);
    if (ZSTD_isError(left) != 0) {
      throw FormatError(std::string("the zstd data of a chunk are broken: ") + ZSTD_getErrorName(left));
    }
    if (left != 0 && part.pos == 0 && in.pos == before) {
      throw FormatError("the zstd data of a chunk end early");
    }
    if (part.pos > size - out.size()) {
      throw FormatError("a chunk has more than the " + std::to_string(size) + " bytes that it tells");
    }
    out.append(piece, 0, part.pos);
  }
  if (in.pos != in.size) {
    throw FormatError("a chunk has bytes after its zstd data");
  }
  return out;
}

}  // namespace

void Compressor::Free::operator()(ZSTD_CCtx_s* context) const noexcept { ZSTD_freeCCtx(context); }

Compressor::Compressor() : context_(ZSTD_createCCtx()) {
  if (context_ == nullptr) {
    throw std::bad_alloc();
  }
}

std::string_view Compressor::compress(std::string_view bytes) {
  if (bytes.size() < kNotWorthIt) {
    return {};
  }
  out_.resize(ZSTD_compressBound(bytes.size()));
  const std::size_t size =
      ZSTD_compressCCtx(context_.get(), out_.data(), out_.size(), bytes.data(), bytes.size(), kLevel);
  if (ZSTD_isError(size) != 0 || size > bytes.size() - bytes.size() / 50) {
    return {};
  }
  return std::string_view(out_).substr(0, size);
}

std::string decompress(std::string_view compression, std::string_view compressed, std::uint64_t size) {
  if (size > kLargestChunk) {
    throw FormatError("a chunk of " + std::to_string(size) + " bytes is larger than the " +
                      std::to_string(kLargestChunk) + " that are permitted");
  }
  std::string out;
  if (compression.empty()) {
    out = compressed.substr(0, static_cast<std::size_t>(kLargestChunk) + 1);
  } else if (compression == "zstd") {
    out = compressed.empty() ? std::string() : decompress_zstd(compressed, size);
  } else {
    throw FormatError("chunks compressed by \"" + std::string(compression.substr(0, 32)) +
                      "\" cannot be read; zstd can");
  }
  if (out.size() != size) {
    throw FormatError("a chunk has " + std::to_string(out.size()) + " bytes and tells " +
                      std::to_string(size));
  }
  return out;
}

}  // namespace haptic::recording
