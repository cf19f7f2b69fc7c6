#include "record/build/part_file.h"

#include <cstring>
#include <fstream>
#include <iterator>
#include <string>

#include "base/atomic_file.h"
#include "base/hash.h"

namespace rhexis::record::build {
namespace {

constexpr std::uint64_t kPartFormat = 0x3130747261706872;  // "rhpart01"

/// Appends values, and reads them in the same order.
class Packer {
 public:
  template <class Value>
  void operator()(const Value& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(Value));
  }
  template <class Value>
  void operator()(const std::vector<Value>& list) {
    (*this)(std::uint64_t{list.size()});
    bytes.append(reinterpret_cast<const char*>(list.data()), list.size() * sizeof(Value));
  }
  std::string bytes;
};
class Unpacker {
 public:
  explicit Unpacker(std::string_view bytes) : left_(bytes) {}
  template <class Value>
  void operator()(Value& value) {
    take(&value, sizeof(Value));
  }
  template <class Value>
  void operator()(std::vector<Value>& list) {
    std::uint64_t size = 0;
    (*this)(size);
    if (size > left_.size() / sizeof(Value)) good_ = false;
    if (!good_) return;
    list.resize(size);
    take(list.data(), size * sizeof(Value));
  }
  [[nodiscard]] bool done() const { return good_ && left_.empty(); }

 private:
  void take(void* to, std::size_t size) {
    good_ = good_ && size <= left_.size();
    if (!good_ || size == 0) return;
    std::memcpy(to, left_.data(), size);
    left_.remove_prefix(size);
  }
  std::string_view left_;
  bool good_ = true;
};

template <class Data, class Use>
void each_field(Data& data, Use& use) {
  use(data.flags);
  use(data.in_solve);
  use(data.stiffness);
  use(data.compliance);
  use(data.rest);
  use(data.moved_nodes);
  use(data.moved_to);
  use(data.gone_tets);
  use(data.frozen_tets);
}

}  // namespace

Expected<void> write_part(const std::filesystem::path& path, std::uint64_t fingerprint, int topology,
                          const store::TopologyData& data) {
  Packer pack;
  pack(kPartFormat);
  pack(fingerprint);
  pack(std::int64_t{topology});
  each_field(data, pack);
  pack(std::uint8_t(data.factor.index()));
  std::visit(pack, data.factor);
  pack(Hash().add(std::span<const char>(pack.bytes)).value());
  return write_atomically(path, pack.bytes);
}

std::optional<store::TopologyData> read_part(const std::filesystem::path& path, std::uint64_t fingerprint,
                                             int topology) {
  std::ifstream stream(path, std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(stream), {});
  std::uint64_t checksum = 0;
  if (bytes.size() < sizeof(checksum)) return std::nullopt;
  const std::string_view packed(bytes.data(), bytes.size() - sizeof(checksum));
  std::memcpy(&checksum, packed.data() + packed.size(), sizeof(checksum));
  if (Hash().add(std::span<const char>(packed)).value() != checksum) return std::nullopt;
  Unpacker unpack(packed);
  std::uint64_t format = 0;
  std::uint64_t of = 0;
  std::int64_t number = -1;
  unpack(format);
  unpack(of);
  unpack(number);
  if (format != kPartFormat || of != fingerprint || number != topology) return std::nullopt;
  store::TopologyData data;
  each_field(data, unpack);
  std::uint8_t single = 0;
  unpack(single);
  if (single != 0) data.factor = std::vector<float>();
  std::visit(unpack, data.factor);
  if (!unpack.done()) return std::nullopt;
  return data;
}

}  // namespace rhexis::record::build
