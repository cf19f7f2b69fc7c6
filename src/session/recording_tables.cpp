#include "session/recording_tables.h"

#include <cstddef>
#include <initializer_list>

namespace rhexis::session {
namespace {

using mesh::io::Hdf5Handle;

struct Member {
  const char* name;
  std::size_t offset;
  hid_t type;
  hsize_t count = 1;
};

Hdf5Handle compound(std::size_t size, std::initializer_list<Member> members) {
  Hdf5Handle type(H5Tcreate(H5T_COMPOUND, size), H5Tclose);
  for (const Member& member : members) {
    if (member.count == 1) {
      H5Tinsert(type, member.name, member.offset, member.type);
      continue;
    }
    const Hdf5Handle array(H5Tarray_create2(member.type, 1, &member.count), H5Tclose);
    H5Tinsert(type, member.name, member.offset, array);
  }
  return type;
}

}  // namespace

template <>
Hdf5Handle row_type<TickRow>() {
  return compound(sizeof(TickRow), {{"tick", offsetof(TickRow, tick), H5T_STD_U64LE},
                                    {"law", offsetof(TickRow, number), H5T_STD_U64LE},
                                    {"position", offsetof(TickRow, position), H5T_IEEE_F64LE, 3},
                                    {"buttons", offsetof(TickRow, buttons), H5T_STD_U32LE},
                                    {"present", offsetof(TickRow, present), H5T_STD_U8LE},
                                    {"fresh", offsetof(TickRow, fresh), H5T_STD_U8LE},
                                    {"late", offsetof(TickRow, late), H5T_STD_U16LE},
                                    {"grasp", offsetof(TickRow, grasp), H5T_STD_U32LE},
                                    {"flags", offsetof(TickRow, flags), H5T_STD_U32LE},
                                    {"hand", offsetof(TickRow, hand), H5T_IEEE_F64LE, 3},
                                    {"force", offsetof(TickRow, force), H5T_IEEE_F64LE, 3}});
}

template <>
Hdf5Handle row_type<StepRow>() {
  using haptics::HandState;
  constexpr std::size_t kHand = offsetof(StepRow, hand);
  return compound(sizeof(StepRow), {{"number", offsetof(StepRow, number), H5T_STD_U64LE},
                                    {"tick", kHand + offsetof(HandState, tick), H5T_STD_U64LE},
                                    {"law_felt", kHand + offsetof(HandState, number), H5T_STD_U64LE},
                                    {"grasp", kHand + offsetof(HandState, grasp), H5T_STD_U32LE},
                                    {"flags", kHand + offsetof(HandState, flags), H5T_STD_U32LE},
                                    {"hand", kHand + offsetof(HandState, hand), H5T_IEEE_F64LE, 3},
                                    {"device", kHand + offsetof(HandState, device), H5T_IEEE_F64LE, 3},
                                    {"device_force", kHand + offsetof(HandState, force), H5T_IEEE_F64LE, 3},
                                    {"felt_force", kHand + offsetof(HandState, body_force), H5T_IEEE_F64LE, 3},
                                    {"fresh", offsetof(StepRow, fresh), H5T_STD_U32LE},
                                    {"advances", offsetof(StepRow, advances), H5T_STD_U32LE},
                                    {"topology", offsetof(StepRow, topology), H5T_STD_U64LE},
                                    {"fingerprint", offsetof(StepRow, fingerprint), H5T_STD_U64LE},
                                    {"law", offsetof(StepRow, law), H5T_STD_U64LE},
                                    {"force", offsetof(StepRow, force), H5T_IEEE_F64LE, 3}});
}

template <>
Hdf5Handle row_type<PieceRow>() {
  return compound(sizeof(PieceRow), {{"at", offsetof(PieceRow, at), H5T_STD_U64LE},
                                     {"kind", offsetof(PieceRow, kind), H5T_STD_U64LE},
                                     {"offset", offsetof(PieceRow, offset), H5T_STD_U64LE},
                                     {"size", offsetof(PieceRow, size), H5T_STD_U64LE}});
}

template <>
Hdf5Handle row_type<FlushRow>() {
  return compound(sizeof(FlushRow), {{"ticks", offsetof(FlushRow, ticks), H5T_STD_U64LE},
                                     {"steps", offsetof(FlushRow, steps), H5T_STD_U64LE},
                                     {"commands", offsetof(FlushRow, commands), H5T_STD_U64LE},
                                     {"scenes", offsetof(FlushRow, scenes), H5T_STD_U64LE},
                                     {"frames", offsetof(FlushRow, frames), H5T_STD_U64LE},
                                     {"bytes", offsetof(FlushRow, bytes), H5T_STD_U64LE}});
}

template <>
Hdf5Handle row_type<std::uint8_t>() {
  return {H5Tcopy(H5T_STD_U8LE), H5Tclose};
}

}  // namespace rhexis::session
