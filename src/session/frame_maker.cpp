#include "session/frame_maker.h"

#include <algorithm>
#include <optional>

#include "scene/live_keys.h"

namespace rhexis::session {
namespace {

wire::Vec3 wire_vector(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
std::unique_ptr<wire::Vec3> own(const Vec3& v) { return std::make_unique<wire::Vec3>(wire_vector(v)); }
std::unique_ptr<wire::Vec3> own(const std::array<double, 3>& v) {
  return std::make_unique<wire::Vec3>(v[0], v[1], v[2]);
}

void add_position(const Vec3& x, std::vector<float>& out) {
  for (Eigen::Index c = 0; c < 3; ++c) out.push_back(static_cast<float>(x[c]));
}

std::vector<std::unique_ptr<wire::FrontT>> fronts_of(const TearSession& tear) {
  std::vector<std::unique_ptr<wire::FrontT>> out;
  for (const fracture::Crack& crack : tear.cracks()) {
    auto front = std::make_unique<wire::FrontT>();
    for (const fracture::FrontPoint& point : crack.front) front->points.push_back(wire_vector(point.position));
    front->finished = crack.finished;
    out.push_back(std::move(front));
  }
  return out;
}

std::unique_ptr<wire::AdvanceT> advance_of(const AdvanceRecord& record, double time) {
  auto out = std::make_unique<wire::AdvanceT>();
  out->topology = static_cast<std::uint32_t>(record.topology);
  out->time = time;
  out->started = record.started;
  out->length = record.length;
  out->angle = record.angle;
  out->tets_removed = static_cast<std::uint32_t>(record.tets_removed);
  out->pieces = static_cast<std::uint32_t>(record.pieces);
  out->volume_lost = record.volume_lost;
  out->milliseconds = 1e3 * (record.remesh_seconds + record.local_seconds + record.update_seconds);
  out->force_before = own(record.force_before);
  out->force_after = own(record.force_after);
  return out;
}

std::unique_ptr<wire::RecordUseT> own(const std::optional<response::RecordUse>& use) {
  if (!use) return nullptr;
  auto out = std::make_unique<wire::RecordUseT>();
  out->topology = static_cast<std::uint32_t>(use->topology);
  out->outside = use->outside;
  out->past_last = use->past_last;
  out->torn_off = use->torn_off;
  return out;
}

std::vector<std::uint32_t> local_slots(const Interaction& interaction) {
  std::vector<std::uint32_t> out;
  for (const fracture::LocalObject& object : interaction.tear().local_objects())
    interaction.body().surface.add_slots_of(object.tets(), out);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

struct HeldFace {
  std::uint32_t slot = 0;
  Vec3 weights = Vec3::Zero();  ///< of the slot's vertices
};

/// A face of the surface that has all nodes of the point.
std::optional<HeldFace> held_face(const response::SurfacePoint& point, const mesh::TornMesh& body,
                                  const SurfaceTracker& surface) {
  for (const TetId tet : body.tets_around(point.node[0])) {
    for (std::int8_t vertex = 0; vertex < 4; ++vertex) {
      const auto slot = surface.slot_of({tet, vertex});
      if (!slot) continue;
      HeldFace face{.slot = *slot};
      int found = 0;
      const auto& corners = surface.faces()[*slot];
      for (std::size_t k = 0; k < 3; ++k) {
        for (int n = 0; n < point.count; ++n) {
          if (surface.nodes()[corners[k]] != point.node[static_cast<std::size_t>(n)]) continue;
          face.weights[static_cast<Eigen::Index>(k)] = point.weight[n];
          ++found;
        }
      }
      if (found == point.count) return face;
    }
  }
  return std::nullopt;
}

}  // namespace

wire::BodyT FrameMaker::body(const Interaction& interaction) {
  const OpenBody& of = interaction.body();
  const TearSession& tear = interaction.tear();
  const mesh::TetMesh& mesh = tear.body().mesh();
  wire::BodyT out;
  out.scene = of.scene.file;
  out.title = of.problem.title;
  out.model = tear.model_name();
  out.epoch = ++epoch_;
  out.topology = static_cast<std::uint32_t>(tear.body().topology());
  out.nodes = static_cast<std::uint32_t>(mesh.node_count());
  out.tets = static_cast<std::uint32_t>(mesh.tet_count());
  const std::vector<NodeId>& nodes = of.surface.nodes();
  for (std::uint32_t vertex = 0; vertex < nodes.size(); ++vertex) {
    add_position(mesh.node(nodes[vertex]), out.positions);
    out.node.push_back(static_cast<std::uint32_t>(nodes[vertex].value()));
    if (tear.supported()[nodes[vertex].index()] != 0) out.held.push_back(vertex);
  }
  for (const auto& face : of.surface.faces()) out.faces.insert(out.faces.end(), face.begin(), face.end());
  out.local = local_slots(interaction);
  out.fronts = fronts_of(tear);
  for (std::size_t k = 0; k < tear.advances().size(); ++k)
    out.advances.push_back(advance_of(tear.advances()[k], of.advance_time[k]));
  out.mean_edge = tear.mean_edge();
  out.max_force = of.problem.interaction.max_force;
  out.values = scene::live_values_json(of.scene.text, of.scene.file, of.scene.overrides).value_or("{}");
  out.script = script_seconds(of.problem.pulls);
  out.response = of.problem.interaction.response;
  out.has_record = of.problem.interaction.record.has_value();
  values_.body_changed();
  basis_.clear();
  return out;
}

wire::EditT FrameMaker::edit(const Interaction& interaction, const SurfaceChange& change) {
  const TearSession& tear = interaction.tear();
  const SurfaceTracker& surface = interaction.body().surface;
  const mesh::TetMesh& mesh = tear.body().mesh();
  wire::EditT out;
  out.epoch = epoch_;
  out.topology = static_cast<std::uint32_t>(tear.body().topology());
  out.moved = change.moved;
  for (const std::uint32_t vertex : change.moved) add_position(mesh.node(surface.nodes()[vertex]), out.moved_to);
  for (std::size_t vertex = change.first_new; vertex < surface.nodes().size(); ++vertex) {
    add_position(mesh.node(surface.nodes()[vertex]), out.new_positions);
    out.new_node.push_back(static_cast<std::uint32_t>(surface.nodes()[vertex].value()));
  }
  out.gone = change.gone;
  out.slots = change.filled;
  for (const std::uint32_t slot : change.filled)
    out.faces.insert(out.faces.end(), surface.faces()[slot].begin(), surface.faces()[slot].end());
  out.local = local_slots(interaction);
  out.fronts = fronts_of(tear);
  out.advance = advance_of(tear.advances().back(), interaction.body().advance_time.back());
  values_.body_changed();
  basis_.clear();
  return out;
}

const VectorX& FrameMaker::displacement(TearSession& tear) {
  const auto held = tear.hand().nodes();
  if (!std::equal(held.begin(), held.end(), held_.begin(), held_.end())) {
    held_.assign(held.begin(), held.end());
    basis_.clear();
  }
  tear.displacement(basis_, u_);
  return u_;
}

wire::StateT FrameMaker::state(const Interaction& interaction, const haptics::HandState& hand) {
  TearSession& tear = interaction.tear();
  const OpenBody& of = interaction.body();
  const VectorX& u = displacement(tear);
  wire::StateT out;
  out.epoch = epoch_;
  out.topology = static_cast<std::uint32_t>(tear.body().topology());
  out.tick = interaction.tick();
  out.time = 1e-3 * static_cast<double>(interaction.tick());
  surface_displacement(of.surface, u, out.displacement);
  out.field = field_;
  values_.find(
      field_, tear.body(), [&](TetId tet) { return tear.stress(tet, u); }, of.surface, u, out.values);
  if (tear.hand().holds()) {
    if (const auto face = held_face(tear.hand().point(), tear.body(), of.surface)) {
      out.held = true;
      out.held_face = face->slot;
      out.held_weights = own(face->weights);
    }
  }
  out.hand = own(hand.device);
  out.force = own(hand.force);
  out.body_force = own(tear.hand().force());
  out.limited = (hand.flags & haptics::HandState::limited) != 0;
  out.hand_work = tear.hand().work();
  out.stored_energy = tear.stored_energy();
  out.crack_area = tear.crack_area();
  out.advances = static_cast<std::uint32_t>(tear.advances().size());
  out.pieces = static_cast<std::uint32_t>(tear.pieces());
  out.paused = interaction.is_paused();
  out.scripted = interaction.is_scripted();
  out.record = own(tear.record_use());
  if (const std::optional<Vec3> compared = tear.compared_force()) out.compared_force = own(*compared);
  return out;
}

}  // namespace rhexis::session
