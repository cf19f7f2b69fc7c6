/// VTK's legacy format, versions 1 to 5.1: keywords in text, arrays in text or big-endian binary.

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

#include "mesh/io/cursor.h"
#include "mesh/io/readers.h"
#include "mesh/io/vtk_cells.h"

namespace rhexis::mesh::io {
namespace {

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

/// nullopt for a type that holds no numbers of whole bytes (bit, string).
std::optional<Scalar> scalar_of(std::string_view name) {
  static constexpr std::array<std::pair<std::string_view, Scalar>, 25> kTypes{{{"unsigned_char", Scalar::uint8},
                                                                               {"char", Scalar::int8},
                                                                               {"signed_char", Scalar::int8},
                                                                               {"unsigned_short", Scalar::uint16},
                                                                               {"short", Scalar::int16},
                                                                               {"unsigned_int", Scalar::uint32},
                                                                               {"int", Scalar::int32},
                                                                               {"unsigned_long", Scalar::uint64},
                                                                               {"long", Scalar::int64},
                                                                               {"float", Scalar::float32},
                                                                               {"double", Scalar::float64},
                                                                               {"vtkidtype", Scalar::int32},
                                                                               {"long_long", Scalar::int64},
                                                                               {"vtktypeint8", Scalar::int8},
                                                                               {"vtktypeuint8", Scalar::uint8},
                                                                               {"vtktypeint16", Scalar::int16},
                                                                               {"vtktypeuint16", Scalar::uint16},
                                                                               {"vtktypeint32", Scalar::int32},
                                                                               {"vtktypeuint32", Scalar::uint32},
                                                                               {"vtktypeint64", Scalar::int64},
                                                                               {"vtktypeuint64", Scalar::uint64},
                                                                               {"unsigned_long_long", Scalar::uint64},
                                                                               {"vtktypefloat32", Scalar::float32},
                                                                               {"vtktypefloat64", Scalar::float64},
                                                                               {"vtktypebool", Scalar::uint8}}};
  const auto at = std::find_if(kTypes.begin(), kTypes.end(), [&](const auto& entry) { return entry.first == name; });
  return at == kTypes.end() ? std::nullopt : std::optional(at->second);
}

/// VTK writes what cannot stand in a word as %XX.
std::string decode_name(std::string_view encoded) {
  std::string out;
  for (std::size_t i = 0; i < encoded.size(); ++i) {
    unsigned value = 0;
    if (encoded[i] == '%' && i + 2 < encoded.size()) {
      const char* digits = encoded.data() + i + 1;
      if (std::from_chars(digits, digits + 2, value, 16).ptr == digits + 2) {
        out += static_cast<char>(value);
        i += 2;
        continue;
      }
    }
    out += encoded[i];
  }
  return out;
}

class VtkReader {
 public:
  explicit VtkReader(std::string_view bytes) : cursor_(bytes) {}

  MeshFile read(const ReadOptions& options) {
    read_head();
    while (!cursor_.at_end()) read_section(cursor_.word("a keyword"));
    if (!cells_set_) cursor_.refuse("it holds no CELLS with CELL_TYPES", "it may be cut short");
    return finish(builder_.take(), options);
  }

 private:
  void read_head() {
    const std::string_view first = cursor_.rest_of_line();
    if (!first.starts_with("# vtk DataFile Version ")) {
      refuse("it is not a legacy VTK file", "its first line should be '# vtk DataFile Version ...'", 1);
    }
    const std::string_view version = first.substr(first.rfind(' ') + 1);
    new_cells_ = version.starts_with("5.") || version == "5";
    if (!new_cells_ && (version.empty() || version.front() < '1' || version.front() > '4')) {
      refuse("VTK file version " + in_quotes(version) + " is not read", "1 to 5.1", 1);
    }
    cursor_.rest_of_line();  // the title
    const std::string format = lower(cursor_.word("ASCII or BINARY"));
    if (format != "ascii" && format != "binary")
      cursor_.refuse("ASCII or BINARY should stand here, not " + in_quotes(format));
    binary_ = format == "binary";
    if (lower(cursor_.word("DATASET")) != "dataset") cursor_.refuse("the line should say DATASET UNSTRUCTURED_GRID");
    if (const auto type = cursor_.word("the kind of data set"); lower(type) != "unstructured_grid") {
      cursor_.refuse(fmt::format("it holds a data set of the kind {}", in_quotes(type)),
                     "save it as UNSTRUCTURED_GRID");
    }
  }

  void read_section(std::string_view word) {
    const std::string keyword = lower(word);
    if (keyword == "points") return read_points();
    if (keyword == "cells") return new_cells_ ? read_new_cells() : read_old_cells();
    if (keyword == "cell_types") return read_cell_types();
    if (keyword == "metadata") return skip_metadata();
    if (keyword == "field") return read_field_block();
    if (keyword == "point_data" || keyword == "cell_data") return start_data(keyword == "point_data");
    if (!centering_ || !read_attribute(keyword)) cursor_.refuse("a keyword should stand here, not " + in_quotes(word));
  }

  void start_data(bool of_points) {
    if (!cells_set_) cursor_.refuse("data stand before points and cells");
    const std::size_t count = read_count("values");
    centering_ = of_points ? Centering::point : Centering::cell;
    entities_ = of_points ? builder_.point_count() : builder_.cell_count();
    if (count != entities_) {
      cursor_.refuse(fmt::format("data for {} {}, there are {}", count, of_points ? "points" : "cells", entities_));
    }
  }

  std::size_t read_count(std::string_view things) {
    const auto count = cursor_.integer(fmt::format("the number of {}", things));
    if (count < 0) cursor_.refuse(fmt::format("the number of {} is {}", things, count));
    check_count(static_cast<std::uint64_t>(count), things, cursor_.line());
    return static_cast<std::size_t>(count);
  }

  /// Values of one array, from the line after its header.
  template <class T>
  Numbers<T> read_array(std::size_t count, Scalar type, std::string_view name) {
    if (!binary_) return read_text<T>(cursor_, count, name);
    cursor_.rest_of_line();
    if (count > cursor_.left() / size_of(type)) {
      cursor_.refuse(fmt::format("{} promises {} values, the rest of the file has room for {}", name, count,
                                 cursor_.left() / size_of(type)),
                     "it may be cut short");
    }
    return {decode<T>(cursor_.binary(count * size_of(type), name), type, /*swap=*/true), {}, 0};
  }

  Scalar read_type() {
    const std::string name = lower(cursor_.word("a data type"));
    const std::optional<Scalar> type = scalar_of(name);
    if (!type) cursor_.refuse(fmt::format("data type {} is not read", in_quotes(name)), "int, float, double, ...");
    return *type;
  }

  void read_points() {
    if (builder_.point_count() > 0) cursor_.refuse("POINTS are there twice");
    const std::size_t count = read_count("points");
    const Scalar type = read_type();
    builder_.set_points(read_array<double>(3 * count, type, "points"));
  }

  /// Version 4: one list, each cell as the number of its points and the points.
  void read_old_cells() {
    const std::size_t cells = read_count("cells");
    const std::size_t size = read_count("entries of the cells");
    const Integers list = read_array<std::int64_t>(size, Scalar::int32, "cells");
    cells_ = VtkCells{};
    Integers& connectivity = cells_.connectivity;
    Integers& ends = cells_.ends;
    connectivity.text = ends.text = list.text;
    connectivity.line = ends.line = list.line;
    std::size_t at = 0;
    for (std::size_t cell = 0; cell < cells; ++cell) {
      const std::int64_t points = at < size ? list.values[at] : -1;
      if (points < 0 || static_cast<std::size_t>(points) > size - at - 1) {
        refuse(fmt::format("cell {} does not fit into the {} entries of the cells", cell, size),
               "is the second number of CELLS right?", list.line_of(std::min(at, size)));
      }
      ends.words.push_back(at++);
      for (std::int64_t k = 0; k < points; ++k) {
        connectivity.words.push_back(at);
        connectivity.values.push_back(list.values[at++]);
      }
      ends.values.push_back(static_cast<std::int64_t>(connectivity.values.size()));
    }
    if (at != size) refuse(fmt::format("{} cells use {} of the {} entries", cells, at, size), "", list.line);
    has_cells_ = true;
  }

  /// Version 5: the number of offsets and of entries, then the two arrays.
  void read_new_cells() {
    const std::size_t offsets = read_count("offsets");
    const std::size_t entries = read_count("entries of the cells");
    const auto read_part = [&](const char* keyword, std::size_t count) {
      if (lower(cursor_.word(keyword)) != lower(keyword))
        cursor_.refuse(fmt::format("{} should follow CELLS", keyword));
      const Scalar type = read_type();
      if (is_float(type)) cursor_.refuse(fmt::format("{} does not hold whole numbers", keyword), "vtktypeint64");
      return read_array<std::int64_t>(count, type, keyword);
    };
    cells_.ends = read_part("OFFSETS", offsets);
    cells_.connectivity = read_part("CONNECTIVITY", entries);
    std::vector<std::int64_t>& values = cells_.ends.values;
    if (values.empty() || values.front() != 0) refuse("OFFSETS should start with 0", "", cells_.ends.line);
    values.erase(values.begin());
    cells_.ends.words.resize(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) cells_.ends.words[i] = i + 1;
    has_cells_ = true;
  }

  void read_cell_types() {
    if (cells_set_) cursor_.refuse("CELL_TYPES are there twice");
    if (!has_cells_) cursor_.refuse("CELL_TYPES stand before CELLS");
    const std::size_t count = read_count("cell types");
    if (count != cells_.ends.values.size()) {
      cursor_.refuse(fmt::format("{} cell types for {} cells", count, cells_.ends.values.size()));
    }
    cells_.types = read_array<std::int64_t>(count, Scalar::int32, "cell types");
    builder_.set_cells(cells_);
    cells_ = VtkCells{};
    cells_set_ = true;
  }

  void skip_metadata() {
    cursor_.rest_of_line();
    while (cursor_.left() > 0 && !cursor_.rest_of_line().empty()) {
    }
  }

  /// One array in the way of VTK's older attributes. False when `keyword` names none.
  bool read_attribute(const std::string& keyword) {
    static constexpr std::array<std::pair<std::string_view, std::size_t>, 6> kComponents{
        {{"vectors", 3}, {"normals", 3}, {"tensors", 9}, {"tensors6", 6}, {"global_ids", 1}, {"pedigree_ids", 1}}};
    const auto fixed =
        std::find_if(kComponents.begin(), kComponents.end(), [&](const auto& k) { return k.first == keyword; });
    const bool own_components = keyword == "color_scalars" || keyword == "texture_coordinates";
    if (keyword == "lookup_table") {
      cursor_.word("a name");
      const std::size_t count = 4 * read_count("colours");
      (void)read_array<double>(count, Scalar::uint8, "colours");
    } else if (keyword == "scalars") {
      read_scalars(decode_name(cursor_.word("a name")));
    } else if (own_components || fixed != kComponents.end()) {
      const std::string name = decode_name(cursor_.word("a name"));
      const std::size_t components = own_components ? read_count("components") : fixed->second;
      add_array(name, components, entities_, keyword == "color_scalars" ? Scalar::uint8 : read_type());
    } else {
      return false;
    }
    return true;
  }

  /// SCALARS name type [components], then optionally LOOKUP_TABLE name.
  void read_scalars(const std::string& name) {
    const Scalar type = read_type();
    const std::size_t components = cursor_.more_on_line() ? read_count("components") : 1;
    if (lower(cursor_.peek()) == "lookup_table") {
      cursor_.word("LOOKUP_TABLE");
      cursor_.word("the name of a lookup table");
    }
    add_array(name, components, entities_, type);
  }

  /// FIELD name count, then arrays: name components tuples type. In front of POINTS it belongs to the whole file.
  void read_field_block() {
    cursor_.word("a name");
    const std::size_t arrays = read_count("arrays");
    for (std::size_t i = 0; i < arrays; ++i) {
      if (lower(cursor_.peek()) == "metadata") {
        cursor_.word("METADATA");
        skip_metadata();
      }
      const std::string name = decode_name(cursor_.word("the name of an array"));
      const std::size_t components = read_count("components");
      const std::size_t tuples = read_count("tuples");
      add_array(name, components, tuples, read_type());
    }
  }

  void add_array(const std::string& name, std::size_t components, std::size_t tuples, Scalar type) {
    Reals values = read_array<double>(components * tuples, type, "array " + in_quotes(name));
    if (!centering_) return builder_.skip_field(name, "it belongs to no points or cells");
    builder_.add_field(name, *centering_, components, std::move(values));
  }

  Cursor cursor_;
  VtkBuilder builder_;
  VtkCells cells_;
  bool binary_ = false;
  bool new_cells_ = false;  ///< version 5's OFFSETS and CONNECTIVITY
  bool has_cells_ = false;
  bool cells_set_ = false;
  std::optional<Centering> centering_;  ///< of the data that follow
  std::size_t entities_ = 0;            ///< their number
};

}  // namespace

Expected<MeshFile> parse_vtk(std::string_view bytes, const std::string& file, const ReadOptions& options) {
  return guarded(file, [&] { return VtkReader(bytes).read(options); });
}

}  // namespace rhexis::mesh::io
