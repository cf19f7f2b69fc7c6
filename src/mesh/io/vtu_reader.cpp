#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "mesh/io/gzip.h"
#include "mesh/io/read_failure.h"
#include "mesh/io/readers.h"
#include "mesh/io/vtk_cells.h"
#include "mesh/io/vtu_array.h"

namespace rhexis::mesh::io {
namespace {

/// Raw appended data are no XML: they are cut off before the rest is parsed.
struct Parts {
  std::string xml;
  std::string_view appended;
  bool appended_base64 = false;
};

Parts cut_appended(std::string_view bytes) {
  const std::size_t tag = bytes.find("<AppendedData");
  if (tag == bytes.npos) return {std::string(bytes), {}, false};
  const std::size_t tag_end = bytes.find('>', tag);
  const std::size_t underscore = tag_end == bytes.npos ? tag_end : bytes.find('_', tag_end);
  if (underscore == bytes.npos) {
    const auto line = 1 + std::count(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(tag), '\n');
    refuse("AppendedData has no underscore before its data", "the file may be cut short", static_cast<int>(line));
  }
  Parts parts;
  parts.appended_base64 = bytes.substr(tag, tag_end - tag).find("base64") != bytes.npos;
  parts.appended = bytes.substr(underscore + 1);
  if (parts.appended_base64) parts.appended = parts.appended.substr(0, parts.appended.find('<'));
  parts.xml = std::string(bytes.substr(0, tag)) + "</VTKFile>";
  return parts;
}

void load_xml(const std::string& xml, pugi::xml_document& document) {
  const pugi::xml_parse_result result =
      document.load_buffer(xml.data(), xml.size(), pugi::parse_default, pugi::encoding_utf8);
  if (result) return;
  const auto end = xml.begin() + std::clamp<std::ptrdiff_t>(result.offset, 0, static_cast<std::ptrdiff_t>(xml.size()));
  const auto line = static_cast<int>(1 + std::count(xml.begin(), end, '\n'));
  if (result.status == pugi::status_out_of_memory) throw std::bad_alloc();
  std::string why = result.description();
  std::transform(why.begin(), why.begin() + (why.empty() ? 0 : 1), why.begin(),
                 [](char c) { return static_cast<char>(std::tolower(c)); });
  refuse("it is not well-formed XML: " + why, "the file may be cut short", line);
}

VtuEncoding read_head(pugi::xml_node root, const Parts& parts, std::size_t file_size) {
  VtuEncoding file{.document = parts.xml,
                   .appended = parts.appended,
                   .appended_base64 = parts.appended_base64,
                   .unpack_budget = std::max(unpacked_limit(file_size), file_size)};
  const int line = line_of(file, root);
  const std::string_view type = root.attribute("type").as_string();
  if (type != "UnstructuredGrid") {
    refuse(fmt::format("it holds a VTK file of the type {}", in_quotes(type)), "save it as UnstructuredGrid", line);
  }
  const std::string_view order = root.attribute("byte_order").as_string("LittleEndian");
  if (order != "LittleEndian" && order != "BigEndian") {
    refuse("byte_order " + in_quotes(order) + " is not known", "LittleEndian or BigEndian", line);
  }
  file.swap = order == "BigEndian";
  const std::string_view header = root.attribute("header_type").as_string("UInt32");
  if (header != "UInt32" && header != "UInt64")
    refuse("header_type " + in_quotes(header) + " is not known", "UInt32 or UInt64", line);
  file.wide_header = header == "UInt64";
  const std::string_view compressor = root.attribute("compressor").as_string();
  if (!compressor.empty() && compressor != "vtkZLibDataCompressor") {
    refuse("compressor " + in_quotes(compressor) + " is not read", "vtkZLibDataCompressor or none", line);
  }
  file.zlib = !compressor.empty();
  return file;
}

bool is_empty(pugi::xml_node piece) {
  return piece.attribute("NumberOfPoints").as_ullong() == 0 && piece.attribute("NumberOfCells").as_ullong() == 0;
}

/// The one piece that is not empty.
pugi::xml_node find_piece(const VtuEncoding& file, pugi::xml_node grid) {
  pugi::xml_node found;
  for (const pugi::xml_node piece : grid.children("Piece")) {
    if (is_empty(piece)) continue;
    if (found) refuse("it holds more than one piece", "merge the pieces before saving", line_of(file, piece));
    found = piece;
  }
  if (!found) refuse("it holds no piece with points", "", line_of(file, grid));
  return found;
}

pugi::xml_node child(const VtuEncoding& file, pugi::xml_node parent, const char* name) {
  const pugi::xml_node node = parent.child(name);
  if (!node) refuse(fmt::format("{} holds no {}", parent.name(), name), "", line_of(file, parent));
  return node;
}

pugi::xml_node find_array(const VtuEncoding& file, pugi::xml_node parent, const char* name) {
  const pugi::xml_node array = parent.find_child_by_attribute("DataArray", "Name", name);
  if (!array) refuse(fmt::format("{} holds no array '{}'", parent.name(), name), "", line_of(file, parent));
  return array;
}

void read_fields(VtuEncoding& file, pugi::xml_node data, Centering centering, VtkBuilder& builder) {
  for (const pugi::xml_node array : data.children()) {
    const std::string name = array.attribute("Name").as_string("unnamed");
    if (std::string_view(array.attribute("type").as_string()) == "String" ||
        std::string_view(array.name()) != "DataArray") {
      builder.skip_field(name, "it holds no numbers");
      continue;
    }
    builder.add_field(name, centering, array.attribute("NumberOfComponents").as_ullong(1), read_reals(file, array));
  }
}

MeshFile read_vtu(std::string_view bytes, const ReadOptions& options) {
  const Parts parts = cut_appended(bytes);
  pugi::xml_document document;
  load_xml(parts.xml, document);
  const pugi::xml_node root = document.child("VTKFile");
  if (!root) refuse("it is not a VTK XML file", "its outermost element should be VTKFile", 1);
  VtuEncoding file = read_head(root, parts, bytes.size());
  const pugi::xml_node piece = find_piece(file, child(file, root, "UnstructuredGrid"));
  VtkBuilder builder;

  const pugi::xml_node points = child(file, child(file, piece, "Points"), "DataArray");
  if (const auto components = points.attribute("NumberOfComponents").as_ullong(3); components != 3) {
    refuse(fmt::format("points have {} components", components), "3, also for flat meshes", line_of(file, points));
  }
  builder.set_points(read_reals(file, points));
  const std::uint64_t promised_points = piece.attribute("NumberOfPoints").as_ullong();
  if (builder.point_count() != promised_points) {
    refuse(fmt::format("the piece promises {} points and holds {}", promised_points, builder.point_count()), "",
           line_of(file, piece));
  }

  const pugi::xml_node cells = child(file, piece, "Cells");
  builder.set_cells({read_integers(file, find_array(file, cells, "connectivity")),
                     read_integers(file, find_array(file, cells, "offsets")),
                     read_integers(file, find_array(file, cells, "types"))});
  const std::uint64_t promised_cells = piece.attribute("NumberOfCells").as_ullong();
  if (builder.cell_count() != promised_cells) {
    refuse(fmt::format("the piece promises {} cells and holds {}", promised_cells, builder.cell_count()), "",
           line_of(file, piece));
  }
  read_fields(file, piece.child("PointData"), Centering::point, builder);
  read_fields(file, piece.child("CellData"), Centering::cell, builder);
  return finish(builder.take(), options);
}

}  // namespace

Expected<MeshFile> parse_vtu(std::string_view bytes, const std::string& file, const ReadOptions& options) {
  return guarded(file, [&] { return read_vtu(bytes, options); });
}

}  // namespace rhexis::mesh::io
