#include <algorithm>
#include <bit>
#include <cstdint>
#include <iterator>
#include <span>

#include <fmt/format.h>

#include "mesh/io/base64.h"
#include "mesh/io/gzip.h"
#include "mesh/io/writers.h"
#include "mesh/io/xml_text.h"

namespace rhexis::mesh::io {
namespace {

static_assert(std::endian::native == std::endian::little, "VTU files are written as LittleEndian from memory");

/// Collects the appended data and hands out offsets into them. Base64 keeps the file well-formed XML.
class AppendedData {
 public:
  template <class T>
  std::size_t add(std::span<const T> values) {
    const std::size_t offset = text_.size();
    const auto raw = std::as_bytes(values);
    const std::string_view bytes(reinterpret_cast<const char*>(raw.data()), raw.size());
    const std::size_t blocks = (bytes.size() + kBlock - 1) / kBlock;
    std::vector<std::uint32_t> header{static_cast<std::uint32_t>(blocks), kBlock,
                                      static_cast<std::uint32_t>(bytes.size() % kBlock)};
    std::string packed;
    for (std::size_t i = 0; i < blocks; ++i) {
      const std::size_t before = packed.size();
      packed += deflate(bytes.substr(i * kBlock, kBlock));
      header.push_back(static_cast<std::uint32_t>(packed.size() - before));
    }
    text_ += base64_encode({reinterpret_cast<const char*>(header.data()), header.size() * sizeof(std::uint32_t)});
    text_ += base64_encode(packed);
    return offset;
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  static constexpr std::uint32_t kBlock = 1U << 18;  ///< bytes before compression
  std::string text_;
};

void add_fields(const std::vector<Field>& fields, Centering centering, const char* element, AppendedData& data,
                std::string& xml) {
  xml += fmt::format("<{}>\n", element);
  for (const Field& field : fields) {
    if (field.centering != centering) continue;
    xml += fmt::format(
        "<DataArray type=\"Float64\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>\n",
        xml_escaped(field.name), field.components, data.add<double>(field.values));
  }
  xml += fmt::format("</{}>\n", element);
}

}  // namespace

std::string format_vtu(const TetMesh& mesh, const std::vector<Field>& fields) {
  std::vector<double> points;
  points.reserve(3 * mesh.node_count());
  for (const Vec3& x : mesh.nodes) points.insert(points.end(), {x[0], x[1], x[2]});
  std::vector<std::int32_t> connectivity;
  connectivity.reserve(4 * mesh.tet_count());
  for (const Tet& tet : mesh.tets) {
    for (const NodeId node : tet) connectivity.push_back(node.value());
  }
  std::vector<std::int64_t> offsets(mesh.tet_count());
  for (std::size_t i = 0; i < offsets.size(); ++i) offsets[i] = 4 * static_cast<std::int64_t>(i + 1);
  constexpr std::uint8_t kVtkTetra = 10;
  const std::vector<std::uint8_t> types(mesh.tet_count(), kVtkTetra);

  AppendedData data;
  std::string xml =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\" header_type=\"UInt32\" "
      "compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n";
  xml += fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", mesh.node_count(), mesh.tet_count());
  add_fields(fields, Centering::point, "PointData", data, xml);
  add_fields(fields, Centering::cell, "CellData", data, xml);
  xml += fmt::format(
      "<Points>\n<DataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\" format=\"appended\" "
      "offset=\"{}\"/>\n</Points>\n<Cells>\n",
      data.add<double>(points));
  const auto add_cells = [&](const char* name, const char* type, std::size_t offset) {
    xml += fmt::format("<DataArray type=\"{}\" Name=\"{}\" format=\"appended\" offset=\"{}\"/>\n", type, name, offset);
  };
  add_cells("connectivity", "Int32", data.add<std::int32_t>(connectivity));
  add_cells("offsets", "Int64", data.add<std::int64_t>(offsets));
  add_cells("types", "UInt8", data.add<std::uint8_t>(types));
  xml += "</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"base64\">\n_";
  return xml + data.text() + "\n</AppendedData>\n</VTKFile>\n";
}

}  // namespace rhexis::mesh::io
