#pragma once

/// One interaction with a body that tears, tick by tick: the hand moves, the body answers, and where its stress says so
/// a crack runs on (sections 2.1 to 2.4 of the method). No clock and no screen: the caller says when a tick is.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "fracture/criterion.h"
#include "fracture/energy_release.h"
#include "fracture/local_object.h"
#include "fracture/path.h"
#include "fracture/path_start.h"
#include "fracture/torn_body.h"
#include "response/force_basis.h"
#include "response/response.h"
#include "scene/scene.h"
#include "session/advance.h"
#include "session/comparison.h"
#include "session/hand.h"
#include "session/tear_settings.h"

namespace rhexis::session {

/// Cracks may run on this often in one tick; what is left goes to the next.
inline constexpr int kMostAdvancesPerTick = 64;

struct TickReport {
  Vec3 force = Vec3::Zero();  ///< N, on the hand, after what tore
  int advances = 0;           ///< made in this tick
  bool let_go = false;        ///< what was held has come off, or belongs to a piece without support
  bool at_rest = true;        ///< another tick with the hand where it is would change nothing
  std::string trouble;  ///< empty; else what kept the tick from being finished: the body is as before that advance
  std::string late;     ///< empty; else why a body of large strain is not where the hand is
};

class TearSession {
 public:
  /// Called after each topology change.
  using Observer = std::function<void(const AdvanceRecord&)>;

  /// The body under its loads, with its first cracks cut. Errors say what is wrong in the user's words, with the place
  /// of the crack that they are about: a crack that misses the body, a body that its cracks leave unstable.
  static Expected<std::unique_ptr<TearSession>> make(const mesh::TetMesh& mesh, TearSettings settings,
                                                     const std::vector<scene::CrackSettings>& cracks);

  /// Takes hold of the surface point nearest to `at` (m, reference). Errors: as Hand::grasp.
  Expected<void> grasp(const Vec3& at, response::ContactMode mode = response::ContactMode::hold);
  void let_go();
  /// Time goes on, s: a body with mass moves by it in the ticks that follow.
  void pass(double seconds) { response_->pass(seconds); }
  /// One tick with the hand displaced by `hand` (m) from where it took hold. `most_advances`, at least 1: what is left
  /// then goes to the next tick; the same place of the hand again takes it up.
  TickReport tick(const Vec3& hand, const Observer& observer = {}, int most_advances = kMostAdvancesPerTick);
  /// The crack runs on by `length` (m) along `direction` (unit, normal to its front), whatever the criterion says: what
  /// experiments need that prescribe the path. The hand stays where it is. `crack` must not be finished.
  TickReport impose(std::size_t crack, const Vec3& direction, double length, const Observer& observer = {});
  /// Takes the last topology change back, the crack with it; a hand that holds a node which goes with it lets go.
  /// False: none is left.
  bool undo();

  /// From now on the force of another response to the same tears is there beside: the recorded one of `record`, or the
  /// exact one (null). It has no part in what happens. False: the torn body has a free motion, and the exact one no
  /// answer; or it is one of large strain, which has no other.
  bool compare(const response::SharedRecord& record);
  void stop_comparing() { comparison_.reset(); }
  /// N, on the hand where it is; empty: nothing is compared, or the other response has no answer any more.
  [[nodiscard]] std::optional<Vec3> compared_force() const;
  /// Empty: the response has no record.
  [[nodiscard]] std::optional<response::RecordUse> record_use() const { return response_->record_use(); }

  [[nodiscard]] const TearSettings& settings() const { return settings_; }
  [[nodiscard]] bool is_linear() const { return response_->is_linear(); }
  [[nodiscard]] std::string_view model_name() const {
    const auto kind = settings_.large_strain ? settings_.large_strain->kind : model::ModelKind::linear;
    return model::kModelNames[static_cast<std::size_t>(kind)];
  }
  /// Cauchy stress of a tet in the solve, Pa; `u`: what displacement() gives.
  [[nodiscard]] Mat3 stress(TetId tet, const VectorX& u) const;
  [[nodiscard]] const mesh::TornMesh& body() const { return torn_.mesh(); }
  [[nodiscard]] const Hand& hand() const { return hand_; }
  [[nodiscard]] const std::vector<fracture::Crack>& cracks() const { return cracks_; }
  /// One per crack that still runs.
  [[nodiscard]] const std::vector<fracture::LocalObject>& local_objects() const { return local_; }
  [[nodiscard]] const std::vector<AdvanceRecord>& advances() const { return advances_; }
  /// Per node, copies too: a support gives some component of its displacement.
  [[nodiscard]] const std::vector<std::uint8_t>& supported() const { return torn_.supported(); }
  [[nodiscard]] int pieces() const { return static_cast<int>(torn_.pieces()); }
  [[nodiscard]] double mean_edge() const { return torn_.mean_edge(); }  ///< m, of the intact body
  [[nodiscard]] double crack_area() const;                              ///< m^2
  [[nodiscard]] double stored_energy();                                 ///< J: Response::stored_energy now
  [[nodiscard]] std::size_t memory_bytes() const { return response_->memory_bytes(); }
  /// Of every node, m; zero out of the solve.
  void displacement(VectorX& u);
  /// The same by what the caller's basis knows of the present topology and hold, the same but for rounding.
  void displacement(response::ForceBasis& basis, VectorX& u);

 private:
  TearSession(const mesh::TetMesh& mesh, TearSettings settings);

  struct Judged {
    fracture::Advance advance;
    double value = 0.0;  ///< Pa or N/m
  };
  /// A topology change that is about to be made.
  struct Change {
    fracture::Incision incision;
    std::function<std::vector<fracture::Crack>()> next_cracks;  ///< called when the body has taken the incision
    std::size_t crack = 0;                                      ///< the one that runs on, or the first new one
    double radius = 0.0;                                        ///< m, how far it runs
    response::CrackAdvance advance;                             ///< the same, as it was asked for
    double seconds = 0.0;                                       ///< spent on planning it
    AdvanceRecord record;                                       ///< filled in as far as is known
  };
  void tear(TickReport& report, const Observer& observer, int most_advances);
  [[nodiscard]] std::optional<Judged> judge(std::size_t crack) const;
  [[nodiscard]] std::vector<fracture::EnergyTet> energies(const fracture::LocalObject& local) const;
  bool run_on(std::size_t crack, Judged judged, TickReport& report, const Observer& observer);
  bool start_crack(TickReport& report, const Observer& observer);
  /// Of cracks that begin.
  [[nodiscard]] Change beginning(std::vector<fracture::Crack> cracks, fracture::Incision incision) const;
  bool take(Change change, TickReport& report, const Observer& observer);

  Expected<void> open(const scene::CrackSettings& crack);
  /// The body gives its last edit back, with the cracks as they were; the response is not told.
  mesh::MeshEdit take_back(const std::vector<fracture::Crack>& cracks);
  void follow_nodes();
  void make_local_objects();
  void solve_local_objects();
  [[nodiscard]] std::vector<fracture::TetStress> surface_stresses(const VectorX& u) const;
  void set_own_stress(fracture::TetStress& tet) const;
  void by_basis(response::ForceBasis& basis, const response::ForceBasis::Solve& solve, VectorX& u) const;
  void move_body();
  [[nodiscard]] double radius_of(std::size_t crack) const;
  [[nodiscard]] std::vector<response::Focus> foci() const;
  /// Of the body as it is: of this record, or the exact one. nullptr: it has a free motion.
  [[nodiscard]] std::unique_ptr<response::Response> make_response(const response::SharedRecord& record) const;
  /// What the local objects have solved by themselves takes its place in the displacement of the body.
  void add_local_objects(VectorX& u) const;

  TearSettings settings_;
  fracture::TornBody torn_;
  std::unique_ptr<fracture::Criterion> criterion_;
  std::unique_ptr<response::Response> response_;  ///< made when the first cracks are cut
  std::optional<Comparison> comparison_;
  std::vector<response::CrackAdvance> made_;  ///< one per edit since then
  Vec3 body_force_ = Vec3::Zero();            ///< N/m^3
  std::vector<Vec3> node_force_;              ///< N, per node; empty without such loads

  std::vector<fracture::Crack> cracks_;
  std::vector<std::vector<fracture::Crack>> cracks_before_;  ///< of each topology but the present one
  std::vector<double> reach_;                                ///< m, length of the last advance of each crack
  std::vector<std::size_t> running_;                         ///< numbers of the cracks that run
  std::vector<fracture::LocalObject> local_;                 ///< one for each of those
  std::vector<bool> solved_alone_;                           ///< each: by the displacement of its boundary
  std::vector<response::ForceBasis> local_basis_;            ///< of the nodes whose displacement each takes
  std::vector<TetId> surface_tets_;                          ///< while no crack runs: where one may start
  response::ForceBasis surface_basis_;                       ///< of every node, then
  std::vector<AdvanceRecord> advances_;
  Hand hand_;
  Vec3 hand_at_ = Vec3::Zero();  ///< m, as of the last tick
  response::MoveReport moved_;   ///< how far the body has come there
  bool has_torn_ = false;        ///< since the body was moved
  /// One after the other the cracks are judged at a place of the hand, round by round until none has torn in a round.
  struct Round {
    std::size_t next = 0;  ///< crack to be judged
    bool tore = false;
  };
  Round round_;  ///< where a tick has left off
  int ticks_ = 0;
};

}  // namespace rhexis::session
