#pragma once

/// One <DataArray> of a VTU file, in any of its encodings.

#include <string_view>

#include <pugixml.hpp>

#include "mesh/io/numbers.h"

namespace rhexis::mesh::io {

/// What the head of the file says about all its arrays.
struct VtuEncoding {
  std::string_view document;  ///< the XML text, for line numbers
  std::string_view appended;  ///< what follows the underscore of <AppendedData>
  bool appended_base64 = false;
  bool swap = false;              ///< binary values are in the other byte order
  bool zlib = false;              ///< binary data are in compressed blocks
  bool wide_header = false;       ///< lengths are UInt64, not UInt32
  std::size_t unpack_budget = 0;  ///< bytes that arrays may still unpack to, over the whole file
};

[[nodiscard]] int line_of(const VtuEncoding& file, pugi::xml_node node);

/// Type of the array; refuses those that hold no numbers.
[[nodiscard]] Scalar scalar_of(const VtuEncoding& file, pugi::xml_node array);

/// All values of an array; takes from the budget. Throws ReadFailure.
[[nodiscard]] Reals read_reals(VtuEncoding& file, pugi::xml_node array);
/// The same for an array that has to hold whole numbers.
[[nodiscard]] Integers read_integers(VtuEncoding& file, pugi::xml_node array);

}  // namespace rhexis::mesh::io
