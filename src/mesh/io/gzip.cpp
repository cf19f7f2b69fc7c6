#include "mesh/io/gzip.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>
#include <zlib.h>

#include "base/check.h"
#include "mesh/io/read_failure.h"

namespace rhexis::mesh::io {
namespace {

constexpr int kGzipWindow = 15 + 16;  // zlib's way to ask for a gzip header
constexpr int kLevel = 6;

Bytef* input_of(std::string_view bytes) {
  return reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));  // zlib's interface lacks the const
}

/// zlib counts in 32 bits.
uInt clamp(std::size_t count) {
  return static_cast<uInt>(std::min<std::size_t>(count, std::numeric_limits<uInt>::max()));
}

class Inflater {
 public:
  explicit Inflater(std::string_view packed) {
    stream_.next_in = input_of(packed);
    stream_.avail_in = clamp(packed.size());
    if (packed.size() > stream_.avail_in) refuse("it is larger than 4 GiB", "split it");
    RHEXIS_CHECK(inflateInit2(&stream_, kGzipWindow) == Z_OK, "zlib cannot start");
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
  z_stream* operator->() { return &stream_; }
  z_stream* get() { return &stream_; }

 private:
  z_stream stream_{};
};

}  // namespace

std::size_t unpacked_limit(std::size_t packed) {
  constexpr std::size_t kMebi = std::size_t{1} << 20;
  constexpr std::size_t kMost = 1024 * kMebi;
  return packed > kMost / 64 ? kMost : std::min(kMost, 64 * packed + 64 * kMebi);
}

bool is_gzip(std::string_view bytes) { return bytes.size() >= 2 && bytes[0] == '\x1f' && bytes[1] == '\x8b'; }

std::string gunzip(std::string_view packed) {
  if (!is_gzip(packed)) refuse("it is not a gzip file", "pack it with gzip, or take .gz off its name");
  const std::size_t limit = unpacked_limit(packed.size());
  Inflater stream(packed);
  std::string out;
  std::size_t filled = 0;
  for (;;) {
    if (filled == out.size()) {
      if (filled == limit) {
        refuse(fmt::format("it unpacks to more than {} MiB", limit >> 20), "unpack it by hand if it can be trusted");
      }
      out.resize(std::min(limit, std::max<std::size_t>(2 * filled, 4 * packed.size() + 1024)));
    }
    stream->next_out = reinterpret_cast<Bytef*>(out.data()) + filled;
    stream->avail_out = clamp(out.size() - filled);
    const uInt offered = stream->avail_out;
    const int code = inflate(stream.get(), Z_NO_FLUSH);
    filled += offered - stream->avail_out;
    if (code == Z_STREAM_END) {
      // A further member may follow; anything else behind is ignored, as gzip does.
      if (stream->avail_in < 2 || stream->next_in[0] != 0x1f || stream->next_in[1] != 0x8b) break;
      inflateReset(stream.get());
    } else if (code == Z_BUF_ERROR && stream->avail_in == 0) {
      refuse("the packed data end early", "it may be cut short");
    } else if (code != Z_OK && code != Z_BUF_ERROR) {
      refuse("the packed data are damaged", "fetch or pack the file again");
    }
  }
  out.resize(filled);
  return out;
}

std::string gzip(std::string_view bytes) {
  z_stream stream{};
  RHEXIS_CHECK(deflateInit2(&stream, kLevel, Z_DEFLATED, kGzipWindow, 8, Z_DEFAULT_STRATEGY) == Z_OK,
               "zlib cannot start");
  std::string out(deflateBound(&stream, bytes.size()), '\0');
  std::size_t taken = 0;
  std::size_t filled = 0;
  int code = Z_OK;
  while (code != Z_STREAM_END) {
    stream.next_in = input_of(bytes.substr(taken));
    stream.avail_in = clamp(bytes.size() - taken);
    stream.next_out = reinterpret_cast<Bytef*>(out.data()) + filled;
    stream.avail_out = clamp(out.size() - filled);
    const uInt offered_in = stream.avail_in;
    const uInt offered_out = stream.avail_out;
    code = ::deflate(&stream, taken + offered_in == bytes.size() ? Z_FINISH : Z_NO_FLUSH);
    RHEXIS_CHECK(code == Z_OK || code == Z_STREAM_END, "zlib stops with code {}", code);
    taken += offered_in - stream.avail_in;
    filled += offered_out - stream.avail_out;
  }
  deflateEnd(&stream);
  out.resize(filled);
  return out;
}

void append_inflated(std::string_view packed, std::size_t size, std::string& out) {
  const std::size_t before = out.size();
  out.resize(before + size);
  uLongf unpacked = size;
  uLong used = packed.size();
  // zlib wants somewhere to write even when there is nothing to.
  Bytef nothing = 0;
  Bytef* target = size > 0 ? reinterpret_cast<Bytef*>(out.data()) + before : &nothing;
  const int code = uncompress2(target, &unpacked, input_of(packed), &used);
  if (code != Z_OK || unpacked != size) refuse("a block of packed data is damaged", "fetch or write the file again");
}

std::string deflate(std::string_view bytes) {
  uLongf size = compressBound(bytes.size());
  std::string out(size, '\0');
  const int code = compress2(reinterpret_cast<Bytef*>(out.data()), &size, input_of(bytes), bytes.size(), kLevel);
  RHEXIS_CHECK(code == Z_OK, "zlib stops with code {}", code);
  out.resize(size);
  return out;
}

}  // namespace rhexis::mesh::io
