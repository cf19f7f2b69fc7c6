#include "mesh/io/mesh_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <set>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/atomic_file.h"
#include "mesh/io/gzip.h"
#include "mesh/io/read_failure.h"
#include "mesh/io/readers.h"
#include "mesh/io/writers.h"
#include "mesh/io/xml_text.h"

namespace rhexis::mesh {
namespace {

namespace fs = std::filesystem;

constexpr const char* kReadable = ".msh, .vtu, .vtk or .vtkhdf, each also with .gz behind";
constexpr const char* kWritable = ".vtkhdf, .vtu or .msh, each also with .gz behind";

struct Ending {
  std::string format;  ///< in lower case, with its dot
  bool gzipped = false;
};

Ending ending_of(const fs::path& path) {
  const auto lower_extension = [](const fs::path& name) {
    std::string text = name.extension().string();
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
  };
  const std::string last = lower_extension(path);
  return last == ".gz" ? Ending{lower_extension(path.stem()), true} : Ending{last, false};
}

/// Larger files are refused before they are loaded.
constexpr std::uintmax_t kLargestFile = std::uintmax_t{8} << 30;

Expected<void> check_fields(const fs::path& path, const TetMesh& mesh, const std::vector<Field>& fields) {
  std::set<std::pair<Centering, std::string>> names;
  for (const Field& field : fields) {
    const bool of_points = field.centering == Centering::point;
    const auto place = [&](std::string what) {
      return fail(fmt::format("field '{}' {}", field.name, what), "", path.string());
    };
    if (field.name.empty() || field.name == "." || field.name.find('/') != std::string::npos) {
      return place("has a name that files cannot hold");
    }
    if (!names.insert({field.centering, field.name}).second) return place("is there twice");
    if (field.components < 1) return place(fmt::format("has {} components", field.components));
    const std::size_t expected =
        (of_points ? mesh.node_count() : mesh.tet_count()) * static_cast<std::size_t>(field.components);
    if (field.values.size() != expected) {
      return place(fmt::format("holds {} values, {} {} with {} components need {}", field.values.size(),
                               of_points ? mesh.node_count() : mesh.tet_count(), of_points ? "nodes" : "tets",
                               field.components, expected));
    }
  }
  return {};
}

}  // namespace

Expected<std::string> read_mesh_bytes(const fs::path& path) {
  const std::string name = path.string();
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (status.type() == fs::file_type::not_found) return fail("there is no such file", "", name);
  if (code) return fail("cannot read: " + code.message(), "", name);
  // A pipe or a device may never end.
  if (status.type() != fs::file_type::regular) return fail("it is not a file", "", name);
  const std::uintmax_t size = fs::file_size(path, code);
  if (code) return fail("cannot read: " + code.message(), "", name);
  if (size > kLargestFile)
    return fail(fmt::format("it is larger than {} GiB", kLargestFile >> 30), "cut the mesh", name);
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::string bytes(size, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(size));
  if (!file) return fail(fmt::format("cannot read: {}", errno != 0 ? std::strerror(errno) : "it ends early"), "", name);
  return bytes;
}

Expected<MeshFile> io::parse_mesh(std::string_view bytes, const std::string& file, const ReadOptions& options) {
  const Ending ending = ending_of(file);
  std::string unpacked;
  if (ending.gzipped) {
    Expected<std::string> result = guarded(file, [&] { return gunzip(bytes); });
    if (!result) return fail(result.error());
    unpacked = std::move(*result);
    bytes = unpacked;
  }
  static constexpr std::array<std::pair<std::string_view, decltype(&parse_msh)>, 4> kReaders{
      {{".msh", parse_msh}, {".vtu", parse_vtu}, {".vtk", parse_vtk}, {".vtkhdf", parse_vtkhdf}}};
  for (const auto& [format, parse] : kReaders) {
    if (ending.format == format) return parse(bytes, file, options);
  }
  return fail(fmt::format("a mesh cannot be read from the ending '{}'", ending.format), kReadable, file);
}

Expected<MeshFile> read_mesh_file(const fs::path& path, const ReadOptions& options) {
  const Expected<std::string> bytes = read_mesh_bytes(path);
  if (!bytes) return fail(bytes.error());
  return io::parse_mesh(*bytes, path.string(), options);
}

Expected<void> write_mesh_file(const fs::path& path, const TetMesh& mesh, const std::vector<Field>& fields) {
  const Ending ending = ending_of(path);
  if (ending.format != ".vtkhdf" && ending.format != ".vtu" && ending.format != ".msh") {
    return fail(fmt::format("a mesh cannot be written with the ending '{}'", ending.format), kWritable, path.string());
  }
  if (Expected<void> good = check_fields(path, mesh, fields); !good) return good;
  std::string bytes;
  if (ending.format == ".vtkhdf") {
    Expected<std::string> image = io::format_vtkhdf(mesh, fields);
    if (!image) return fail(image.error().at(path.string()));
    bytes = std::move(*image);
  } else {
    bytes = ending.format == ".vtu" ? io::format_vtu(mesh, fields) : io::format_msh(mesh);
  }
  return write_atomically(path, ending.gzipped ? io::gzip(bytes) : bytes);
}

Expected<void> write_series(const fs::path& path, const std::vector<SeriesEntry>& entries) {
  std::string xml =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
      "byte_order=\"LittleEndian\">\n<Collection>\n";
  for (const SeriesEntry& entry : entries) {
    xml += fmt::format("<DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", entry.value, io::xml_escaped(entry.file));
  }
  return write_atomically(path, xml + "</Collection>\n</VTKFile>\n");
}

}  // namespace rhexis::mesh
