// rhexis mesh info|convert|make: look at a mesh, change its format, generate one.

#include <vector>

#include "apps/command.h"
#include "mesh/generate.h"
#include "mesh/io/mesh_file.h"
#include "mesh/quality.h"
#include "mesh/surface.h"
#include "mesh/validate.h"
#include "scene/units.h"

namespace rhexis::apps {
namespace {

using nlohmann::ordered_json;

ordered_json range_json(const mesh::Range& range) {
  return {{"min", range.min}, {"mean", range.mean}, {"max", range.max}};
}

ordered_json info_json(const mesh::MeshFile& file) {
  const mesh::TetMesh& mesh = file.mesh;
  const std::vector<mesh::Defect> defects = mesh::find_defects(mesh);
  const mesh::BoundingBox box = mesh::bounding_box(mesh);
  ordered_json json{{"nodes", mesh.node_count()}, {"tets", mesh.tet_count()}};
  const mesh::FaceTable faces = mesh::find_faces(mesh);
  json["boundary_triangles"] = faces.boundary.size();
  json["volume"] = mesh::total_volume(mesh);
  json["box"] = {{"from", vector_json(box.from)}, {"to", vector_json(box.to)}};
  json["thickness"] = mesh::thickness(mesh);
  const mesh::Quality quality = mesh::measure_quality(mesh);
  json["dihedral_degrees"] = range_json(quality.dihedral);
  json["radius_ratio"] = range_json(quality.radius_ratio);
  json["edge"] = range_json(quality.edge);
  json["node_sets"] = ordered_json::object();
  for (const mesh::NodeSet& set : mesh.node_sets) json["node_sets"][set.name] = set.nodes.size();
  json["face_sets"] = ordered_json::object();
  for (const mesh::FaceSet& set : mesh.face_sets) json["face_sets"][set.name] = set.faces.size();
  json["fields"] = ordered_json::array();
  for (const mesh::Field& field : file.fields) json["fields"].push_back(field.name);
  json["notes"] = file.notes;
  json["defects"] = ordered_json::array();
  for (const mesh::Defect& defect : defects) json["defects"].push_back(defect.what);
  return json;
}

void print_info(const ordered_json& info) {
  const auto range = [](const ordered_json& r) {
    return fmt::format("{:.4g} .. {:.4g}, mean {:.4g}", r["min"].get<double>(), r["max"].get<double>(),
                       r["mean"].get<double>());
  };
  const auto point = [](const ordered_json& p) {
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", p[0].get<double>(), p[1].get<double>(), p[2].get<double>());
  };
  fmt::print("nodes           {}\ntets            {}\nboundary        {} triangles\n", info["nodes"].get<std::size_t>(),
             info["tets"].get<std::size_t>(), info["boundary_triangles"].get<std::size_t>());
  fmt::print("box             {} .. {} m\n", point(info["box"]["from"]), point(info["box"]["to"]));
  fmt::print("volume          {:.6g} m^3\nthickness       {:.4g} m\n", info["volume"].get<double>(),
             info["thickness"].get<double>());
  fmt::print("dihedral angle  {} degrees\nradius ratio    {} (1 is regular)\nedge            {} m\n",
             range(info["dihedral_degrees"]), range(info["radius_ratio"]), range(info["edge"]));
  for (const auto& [name, count] : info["node_sets"].items()) {
    const bool has_faces = info["face_sets"].contains(name);
    fmt::print("set             {}: {} nodes{}\n", name, count.get<std::size_t>(),
               has_faces ? fmt::format(", {} faces", info["face_sets"][name].get<std::size_t>()) : "");
  }
  for (const auto& field : info["fields"]) fmt::print("field           {}\n", field.get<std::string>());
  for (const auto& note : info["notes"]) fmt::print("note            {}\n", note.get<std::string>());
  for (const auto& defect : info["defects"]) fmt::print("defect          {}\n", defect.get<std::string>());
  if (info["defects"].empty()) fmt::print("defects         none\n");
}

/// The unit's name goes into `unit`, which says what stands for none given.
void add_unit_option(CLI::App& command, std::string& unit) {
  const std::string names = fmt::format("{}", fmt::join(scene::unit_names(), ", "));
  command.add_option("--unit", unit, "length unit of the file that is read, one of " + names)
      ->option_text("UNIT=" + unit)
      ->check([names](const std::string& name) {
        return scene::metres_per(name) > 0.0 ? std::string()
                                             : fmt::format("'{}' is no length unit (one of {})", name, names);
      });
}

/// Writes the mesh and says so. Returns the exit code.
int write_mesh(const std::string& path, const mesh::TetMesh& mesh, const std::vector<mesh::Field>& fields,
               const Common& common) {
  const Expected<void> written = mesh::write_mesh_file(path, mesh, fields);
  if (!written) return report(written.error());
  say(common, "{}: {} nodes, {} tets\n", path, mesh.node_count(), mesh.tet_count());
  if (common.json) print_json({{"file", path}, {"nodes", mesh.node_count()}, {"tets", mesh.tet_count()}});
  return kDone;
}

void add_info(CLI::App& mesh_app, const Common& common, int& code) {
  CLI::App* command = mesh_app.add_subcommand("info", "Counts, sets, size, quality and every defect of a mesh");
  command->footer("Example: rhexis mesh info vessel.msh --unit mm");
  struct Options {
    std::string file;
    std::string unit = "m";
  };
  auto options = std::make_shared<Options>();
  command->add_option("file", options->file, "mesh or result file")->required();
  add_unit_option(*command, options->unit);
  command->callback([options, &common, &code] {
    const Expected<mesh::MeshFile> file =
        mesh::read_mesh_file(options->file, {.unit = scene::metres_per(options->unit)});
    if (!file) {
      code = report(file.error());
      return;
    }
    const ordered_json info = info_json(*file);
    if (common.json)
      print_json(info);
    else if (!common.quiet)
      print_info(info);
  });
}

void add_convert(CLI::App& mesh_app, const Common& common, int& code) {
  CLI::App* command =
      mesh_app.add_subcommand("convert", "Read one format, write another: .msh, .vtu, .vtkhdf (and .vtk to read)");
  command->footer("Example: rhexis mesh convert kidney.msh.gz kidney.vtu");
  struct Options {
    std::string from, to;
    std::string unit = "m";
  };
  auto options = std::make_shared<Options>();
  command->add_option("from", options->from, "file to read")->required();
  command->add_option("to", options->to, "file to write, in metres")->required();
  add_unit_option(*command, options->unit);
  command->callback([options, &common, &code] {
    const Expected<mesh::MeshFile> file =
        mesh::read_mesh_file(options->from, {.unit = scene::metres_per(options->unit)});
    if (!file) {
      code = report(file.error());
      return;
    }
    for (const std::string& note : file->notes) spdlog::info("{}", note);
    code = write_mesh(options->to, file->mesh, file->fields, common);
  });
}

struct MakeOptions {
  std::string out;
  int nodes = 1000;
  std::vector<double> size{1.0, 1.0, 1.0};
  mesh::TubeShape tube;
};

void add_shape(CLI::App& make_app, const std::string& name, const std::string& description, const std::string& example,
               const Common& common, int& code) {
  CLI::App* command = make_app.add_subcommand(name, description);
  command->footer("Example: rhexis mesh make " + name + " " + example);
  auto options = std::make_shared<MakeOptions>();
  command->add_option("out", options->out, "file to write")->required();
  command->add_option("--nodes", options->nodes, "number of nodes, met within 2%")->required();
  if (name == "tube") {
    command->add_option("--radius", options->tube.radius, "outer radius, m")->required();
    command->add_option("--length", options->tube.length, "of the centre line, m")->required();
    command->add_option("--wall", options->tube.wall, "thickness of the wall, m; 0 for a solid rod");
    command->add_option("--bend", options->tube.bend, "degrees by which the centre line turns");
  } else {
    command->add_option("--size", options->size, name == "cube" ? "side, m" : "three sides, m")
        ->expected(name == "cube" ? 1 : 3)
        ->required();
  }
  command->callback([name, options, &common, &code] {
    if (name == "cube") options->size.resize(3, options->size.front());
    const mesh::BoxShape box{Vec3(options->size[0], options->size[1], options->size[2])};
    const Expected<mesh::TetMesh> made = name == "tube"    ? mesh::make_tube(options->tube, options->nodes)
                                         : name == "plate" ? mesh::make_plate(box, options->nodes)
                                                           : mesh::make_bar(box, options->nodes);
    code = made ? write_mesh(options->out, *made, {}, common) : report(made.error());
  });
}

}  // namespace

void add_mesh(CLI::App& app, const Common& common, int& code) {
  CLI::App* command = app.add_subcommand("mesh", "Look at a mesh, convert it, generate one");
  command->footer("Example: rhexis mesh info vessel.msh --unit mm");
  command->require_subcommand(1);
  command->fallthrough();
  add_info(*command, common, code);
  add_convert(*command, common, code);
  CLI::App* make = command->add_subcommand("make", "Generate a plate, bar, tube or cube");
  make->footer("Example: rhexis mesh make plate plate.msh --size 0.24 0.24 0.01 --nodes 506");
  make->require_subcommand(1);
  make->fallthrough();
  add_shape(*make, "plate", "A plate, thin in z", "plate.msh --size 0.24 0.24 0.01 --nodes 506", common, code);
  add_shape(*make, "bar", "A box", "bar.msh --size 0.1 0.1 0.4 --nodes 2000", common, code);
  add_shape(*make, "cube", "A cube", "cube.msh --size 0.1 --nodes 1000", common, code);
  add_shape(*make, "tube", "A tube along z, straight or bent, with a wall or solid",
            "tube.msh --radius 0.005 --length 0.04 --nodes 401", common, code);
}

}  // namespace rhexis::apps
