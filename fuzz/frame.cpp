// Any bytes as a frame of the wire: refused, or one that says the same when it is encoded again.

#include "wire/frame.h"
#include "base/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace rhexis;
  const std::vector<std::uint8_t> bytes(data, data + size);  // aligned, as those who decode have them
  const auto frame = wire::decode(bytes);
  if (!frame) {
    RHEXIS_CHECK(!frame.error().what.empty(), "an error without words");
    return 0;
  }
  RHEXIS_CHECK((*frame)->payload.value != nullptr, "a frame without a payload");
  const wire::SharedMessage once = wire::encode_frame(**frame);
  const auto again = wire::decode(once->bytes);
  RHEXIS_CHECK(again && (*again)->payload.type == (*frame)->payload.type, "a frame that cannot be encoded");
  RHEXIS_CHECK(wire::encode_frame(**again)->bytes == once->bytes, "a frame that does not keep what it says");
  return 0;
}
