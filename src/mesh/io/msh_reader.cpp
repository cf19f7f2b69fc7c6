/// Gmsh's MSH: the frame of sections that versions 2 and 4 share.

#include "mesh/io/msh_input.h"
#include "mesh/io/readers.h"

namespace rhexis::mesh::io {
namespace {

enum class Version { msh2, msh4 };

Version read_format(MshInput& in) {
  Cursor& cursor = in.cursor;
  if (cursor.at_end()) cursor.refuse("it is empty");
  if (const std::string_view first = cursor.word("$MeshFormat"); first != "$MeshFormat") {
    cursor.refuse(fmt::format("it starts with {}, a Gmsh file with '$MeshFormat'", in_quotes(first)),
                  first == "$NOD" ? "MSH 1 is not read, save as 4.1 or 2.2" : "");
  }
  cursor.begin_record("the format");
  const std::string_view version = cursor.word("the version");
  const std::int64_t type = cursor.integer("the file type");
  const std::int64_t data_size = cursor.integer("the data size");
  cursor.end_record("the format");
  const bool msh2 = version == "2" || version.starts_with("2.");
  if (!msh2 && version != "4.1")
    cursor.refuse(fmt::format("MSH version {} is not read", in_quotes(version)), "save as 4.1 or 2.2");
  if (type != 0 && type != 1) cursor.refuse(fmt::format("file type {} is not known", type), "0 for text, 1 for binary");
  if (data_size != 8) cursor.refuse(fmt::format("a data size of {} is not read", data_size), "it should be 8");
  in.binary = type == 1;
  if (in.binary) {
    cursor.rest_of_line();
    const auto one = cursor.binary_value<std::int32_t>(false, "the byte order mark");
    constexpr std::int32_t kSwappedOne = 0x01000000;
    if (one != 1 && one != kSwappedOne) cursor.refuse("the byte order mark is damaged", "it should be the integer 1");
    in.swap = one == kSwappedOne;
  }
  return msh2 ? Version::msh2 : Version::msh4;
}

void read_physical_names(MshInput& in) {
  Cursor& cursor = in.cursor;
  const auto count = cursor.integer<std::uint32_t>("the number of physical names");
  cursor.check_room(count, 6, "physical names");
  for (std::uint32_t i = 0; i < count; ++i) {
    cursor.begin_record("a physical name");
    const auto dimension = cursor.integer<int>("a dimension");
    const std::int64_t tag = cursor.integer("a physical tag");
    const int line = cursor.line();
    // A name may hold blanks: it is what stands between the first and the last quote of the line.
    const std::string_view rest = cursor.rest_of_line();
    if (rest.size() < 2 || rest.front() != '"' || rest.back() != '"') {
      refuse(fmt::format("a name in quotes should follow, not {}", in_quotes(rest)), "", line);
    }
    if (dimension < 0 || dimension > 3) refuse(fmt::format("a group of dimension {}", dimension), "0 to 3", line);
    in.group(dimension, tag, std::string(rest.substr(1, rest.size() - 2)));
  }
}

void skip_section(MshInput& in, const std::string& name) {
  if (!in.cursor.skip_past("$End" + name))
    in.cursor.refuse(fmt::format("section ${} has no end", name), "the file may be cut short");
}

void close_section(MshInput& in, const std::string& name) {
  // The end of a binary section stands behind its data without a line of its own being promised.
  const std::string_view end = in.cursor.word("$End" + name);
  if (end != "$End" + name) {
    in.cursor.refuse(fmt::format("section ${} goes on with {} where it should end", name, in_quotes(end)),
                     "is its count right?");
  }
}

MeshFile read_msh(std::string_view bytes, const ReadOptions& options) {
  MshInput in(bytes);
  const Version version = read_format(in);
  close_section(in, "MeshFormat");
  MshEntities entities;
  bool has_elements = false;
  while (!in.cursor.at_end()) {
    const std::string_view opening = in.cursor.word("a section");
    if (opening.size() < 2 || opening.front() != '$') {
      in.cursor.refuse(fmt::format("a section should start here, not {}", in_quotes(opening)));
    }
    const std::string name(opening.substr(1));
    const bool is_nodes = name == "Nodes";
    const bool is_elements = name == "Elements";
    if (is_nodes || is_elements || name == "Entities") {
      if (is_nodes ? in.has_nodes : is_elements && has_elements)
        in.cursor.refuse(fmt::format("section ${} is there twice", name));
      if (is_elements && !in.has_nodes) in.cursor.refuse("$Elements stands before $Nodes");
      if (in.binary) in.cursor.rest_of_line();
    }
    if (name == "PhysicalNames") {
      read_physical_names(in);
    } else if (name == "Entities" && version == Version::msh4) {
      entities = read_msh4_entities(in);
    } else if (is_nodes) {
      version == Version::msh2 ? read_msh2_nodes(in) : read_msh4_nodes(in);
      in.has_nodes = true;
    } else if (is_elements) {
      version == Version::msh2 ? read_msh2_elements(in) : read_msh4_elements(in, entities);
      has_elements = true;
    } else {
      if (name == "NodeData" || name == "ElementData" || name == "ElementNodeData") {
        in.mesh.notes.push_back(fmt::format("section ${} left out: fields are read from VTK's formats", name));
      }
      skip_section(in, name);
      continue;
    }
    close_section(in, name);
  }
  if (!has_elements) in.cursor.refuse("it holds no section $Elements", "the file may be cut short");
  return finish(std::move(in.mesh), options);
}

}  // namespace

Expected<MeshFile> parse_msh(std::string_view bytes, const std::string& file, const ReadOptions& options) {
  return guarded(file, [&] { return read_msh(bytes, options); });
}

}  // namespace rhexis::mesh::io
