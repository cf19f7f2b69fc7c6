#pragma once

/// What has to be asked of a foreign HDF5 file before the library touches its data, since 1.10 can crash on hostile
/// ones.

#include <hdf5.h>

namespace rhexis::mesh::io {

/// There, and no link to somewhere else.
[[nodiscard]] bool is_hard_link(hid_t group, const char* name);
/// A hard link to an object of that type.
[[nodiscard]] bool is_object(hid_t group, const char* name, H5O_type_t wanted);
/// Of a dataset: stored in the file itself, and packed by nothing but zlib.
[[nodiscard]] bool is_plain_storage(hid_t data);

}  // namespace rhexis::mesh::io
