// A record against the torn bodies that it was made of, solved the slow way; and the campaign that makes it, however it
// is cut up.

#include "record/build/campaign.h"

#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>

#include <Eigen/LU>

#include "base/parallel.h"
#include "record/store/record_reader.h"
#include "record/store/record_writer.h"
#include "tests/record/build/recorded_plate.h"
#include "tests/support/measured.h"
#include "tests/support/run_command.h"
#include "tests/support/torn_body_oracle.h"

namespace rhexis::record::build {
namespace {

namespace fs = std::filesystem;
using rhexis::test::fresh_folder;
using rhexis::test::slurp;
using store::RecordFile;
using testing::HasSubstr;

CampaignReport run(const CampaignRequest& request, const fs::path& file, Rank rank = {},
                   const Campaign::Observer& observe = {}) {
  const Expected<Campaign> campaign = Campaign::plan(request);
  EXPECT_TRUE(campaign) << campaign.error().message();
  const Expected<CampaignReport> report = campaign->run(file, rank, observe);
  EXPECT_TRUE(report) << report.error().message();
  return report.value_or(CampaignReport{});
}

/// What the record says of some topologies, against all of the body assembled and factored.
void expect_torn_bodies(const CampaignRequest& request, const fs::path& file, double tolerance) {
  const Expected<RecordFile> record = RecordFile::open(file);
  ASSERT_TRUE(record) << record.error().message();
  const Expected<store::Record> all = record->read_record();
  ASSERT_TRUE(all) << all.error().message();
  const store::RecordHead& head = record->head();
  double stiffness = 0.0;
  double compliance = 0.0;
  double rest = 0.0;
  double whole = 0.0;
  for (const int number : {0, 1, 2, 3, 5, 8, 12}) {
    const TornState state = test::torn(request, number);
    rhexis::test::TornBodyOracle oracle(state.body.mesh(), request.elastic);
    ASSERT_TRUE(oracle.is_stable());
    const Expected<store::TopologyData> data = record->read_topology(number);
    ASSERT_TRUE(data) << data.error().message();
    const auto node_of = [&](std::size_t point) { return NodeId(head.points[point]); };
    for (std::size_t point = 0; point < head.points.size(); point += 17) {
      ASSERT_EQ(data->in_solve[point], 1);
      const Mat3 K = oracle.compliance({node_of(point)}).inverse();
      const Mat3 is = all->stiffness_at(number, static_cast<int>(point));
      stiffness = std::max(stiffness, (is - K).norm() / K.norm());
    }
    for (std::size_t edge = 0; edge < head.edges.size(); edge += 41) {
      const auto& [a, b] = head.edges[edge];
      const std::vector<NodeId> ends{node_of(static_cast<std::size_t>(a)), node_of(static_cast<std::size_t>(b))};
      const Eigen::MatrixXd L = oracle.compliance(ends);
      const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> is(data->compliance.data() + 9 * edge);
      compliance = std::max(compliance, (is - L.block<3, 3>(0, 3)).norm() / L.norm());
    }
    const NodeId held = node_of(head.points.size() / 2);
    const VectorX force = Vec3(0.3, -0.2, 0.1);
    const VectorX u = oracle.displacement({held}, force);
    VectorX forces = VectorX::Zero(u.size());
    forces.segment<3>(3 * Eigen::Index{held.value()}) = force;
    VectorX is =
        std::visit([&](const auto& factor) { return store::displacement_by(head.pattern, std::span(factor), forces); },
                   data->factor);
    if (head.has_loads) {
      const Eigen::Map<const VectorX> at_rest(data->rest.data(), u.size());
      is += at_rest;
      const VectorX wanted = oracle.displacement({}, VectorX());
      rest = std::max(rest, (at_rest - wanted).norm() / wanted.norm());
    }
    whole = std::max(whole, (is - u).norm() / u.norm());

    // The edits name the mesh of the topology.
    std::vector<double> positions = head.nodes;
    for (std::size_t k = 0; k < data->moved_nodes.size(); ++k)
      std::copy_n(data->moved_to.begin() + static_cast<std::ptrdiff_t>(3 * k), 3,
                  positions.begin() + 3 * data->moved_nodes[k]);
    const mesh::TetMesh& mesh = state.body.mesh().mesh();
    EXPECT_TRUE(std::equal(positions.begin(), positions.end(), mesh.nodes.front().data()));
    for (std::size_t t = 0; t < mesh.tet_count(); ++t)
      EXPECT_EQ(state.body.mesh().is_alive(TetId(t)),
                !std::binary_search(data->gone_tets.begin(), data->gone_tets.end(), static_cast<std::int32_t>(t)));
  }
  rhexis::test::measured("{}, {}: stiffness {:.1e}, edges {:.1e}, rest {:.1e}, whole displacement {:.1e}",
                         head.has_loads ? "loaded" : "no loads", head.single_precision ? "single" : "double", stiffness,
                         compliance, rest, whole);
  EXPECT_LT(stiffness, 1e-10);
  EXPECT_LT(compliance, 1e-10);
  EXPECT_LT(rest, 1e-9);
  EXPECT_LT(whole, tolerance);
}

TEST(Campaign, RecordsTheTornBodies) {
  const fs::path file = fresh_folder("campaign") / "plate.h5";
  const CampaignRequest request = test::plate(300, false);
  const CampaignReport report = run(request, file);
  EXPECT_EQ(report.ending, Ending::complete);
  EXPECT_EQ(report.computed, 13);
  EXPECT_EQ(report.file_bytes, fs::file_size(file));
  EXPECT_FALSE(fs::exists(file.string() + ".parts"));
  expect_torn_bodies(request, file, 1e-9);
}

TEST(Campaign, RecordsWhatLoadsDo) {
  const fs::path file = fresh_folder("campaign") / "plate.h5";
  const CampaignRequest request = test::plate(200, true);
  run(request, file);
  expect_torn_bodies(request, file, 1e-9);
}

/// The operators alone lose digits: forces do not.
TEST(Campaign, InSinglePrecisionForcesAreThoseOfDouble) {
  const fs::path folder = fresh_folder("campaign");
  CampaignRequest request = test::plate(300, false);
  run(request, folder / "double.h5");
  request.single_precision = true;
  run(request, folder / "single.h5");
  EXPECT_EQ(RecordFile::open(folder / "single.h5")->read_record()->stiffness,
            RecordFile::open(folder / "double.h5")->read_record()->stiffness);
  expect_torn_bodies(request, folder / "single.h5", 1e-5);  // 2^-24 times the root of the condition number, or so
}

/// The numbers of docs/record-format.md: the plate of the thesis, all directions of its first advance.
TEST(Campaign, OnThePlateOfTheThesisSinglePrecisionIsEnoughToShowTheBody) {
  CampaignRequest request = test::plate(506, false);
  request.parameters.directions = 13;
  const Recorder recorder(request.mesh, request.elastic, true);
  const store::OperatorPattern& pattern = recorder.layout().pattern();
  double worst = 0.0;
  for (int number = 0; number <= 13; ++number) {
    FactoredState state{test::torn(request, number), OperatorFactor(recorder.layout())};
    ASSERT_TRUE(recorder.factor(state));
    const std::vector<float> single(state.factor.values().begin(), state.factor.values().end());
    for (std::size_t point = 0; point < recorder.points().size(); point += 40) {
      for (int component = 0; component < 3; ++component) {
        VectorX force = VectorX::Zero(static_cast<Eigen::Index>(3 * request.mesh.node_count()));
        force[3 * Eigen::Index{recorder.points()[point]} + component] = 1.0;
        const VectorX u = store::displacement_by(pattern, std::span(state.factor.values()), force);
        const VectorX rounded = store::displacement_by(pattern, std::span(single), force);
        worst = std::max(worst, (rounded - u).norm() / u.norm());
      }
    }
  }
  rhexis::test::measured("506 nodes: displacement by operators in single precision within {:.1e}", worst);
  EXPECT_LT(worst, 1e-4);
}

/// A crack that has left the body runs no further.
TEST(Campaign, SaysWhatOpenedNothing) {
  const fs::path file = fresh_folder("campaign") / "plate.h5";
  CampaignRequest request = test::plate(200, false);
  request.parameters.advances = 3;
  request.parameters.directions = 1;
  request.parameters.lengths = {0.12};  // the second one leaves the body
  run(request, file);
  const Expected<RecordFile> record = RecordFile::open(file);
  ASSERT_TRUE(record);
  ASSERT_EQ(record->topologies(), 4);
  const store::Record all = *record->read_record();
  EXPECT_EQ(all.flags[0], 0);
  EXPECT_EQ(all.flags[1], 0);
  EXPECT_EQ(all.flags[2] & store::came_through, store::came_through);
  EXPECT_EQ(all.flags[3], store::came_through | store::opened_nothing);
  store::TopologyData last = *record->read_topology(3);
  last.flags = all.flags[2];
  EXPECT_TRUE(last == *record->read_topology(2));
}

TEST(Campaign, IsTheSameBytesHoweverItIsCutUp) {
  const fs::path folder = fresh_folder("campaign");
  const CampaignRequest request = test::plate(200, true);
  set_thread_count(1);
  run(request, folder / "one.h5");
  const std::string whole = slurp(folder / "one.h5");
  set_thread_count(3);
  run(request, folder / "three.h5");
  EXPECT_TRUE(slurp(folder / "three.h5") == whole);
  set_thread_count(0);

  // Stopped again and again; a part that was left half-written, or has decayed, is made anew.
  int runs = 0;
  for (Ending ending = Ending::stopped; ending == Ending::stopped; ++runs) {
    int made = 0;
    const CampaignReport report =
        run(request, folder / "stopped.h5", {}, [&](int there, int all) { return ++made < 2 || there == all; });
    ending = report.ending;
    const fs::path parts = folder / "stopped.h5.parts";
    if (runs == 1) {
      fs::resize_file(parts / "topology_000000", 1000);
      std::ofstream(parts / "topology_000004.part12345") << "left by a killed one";
      std::fstream spoilt(parts / "topology_000001", std::ios::in | std::ios::out | std::ios::binary);
      spoilt.seekp(500);
      spoilt.put('x');
    }
    ASSERT_LT(runs, 20);
  }
  EXPECT_GT(runs, 3);
  EXPECT_TRUE(slurp(folder / "stopped.h5") == whole);
  EXPECT_FALSE(fs::exists(folder / "stopped.h5.parts"));

  // Of two ranks the first to come does its share, and here also the other's.
  EXPECT_EQ(run(request, folder / "ranks.h5", {1, 2}).ending, Ending::complete);
  EXPECT_TRUE(slurp(folder / "ranks.h5") == whole);
  // Killed when the record stood, and its parts too.
  fs::create_directories(folder / "ranks.h5.parts");
  std::ofstream(folder / "ranks.h5.parts/fingerprint")
      << fmt::format("{:016x}\n", *store::fingerprint_of(folder / "ranks.h5"));
  EXPECT_EQ(run(request, folder / "ranks.h5", {0, 2}).ending, Ending::was_there);
  EXPECT_FALSE(fs::exists(folder / "ranks.h5.parts"));
}

TEST(Campaign, MeetsNoOtherRecord) {
  const fs::path folder = fresh_folder("campaign");
  const fs::path file = folder / "plate.h5";
  CampaignRequest request = test::plate(150, false);
  run(request, file, {}, [](int, int) { return false; });
  const auto refusal = [&](const CampaignRequest& other) {
    const Expected<CampaignReport> report = Campaign::plan(other)->run(file, {}, {});
    return report ? "taken" : report.error().message();
  };
  for (int way = 0; way < 6; ++way) {
    CampaignRequest other = request;
    if (way == 0) other.elastic.elastic.young *= 2.0;
    if (way == 1) other.parameters.lengths = {0.05};
    if (way == 2) other.crack.to[1] = 0.07;
    if (way == 3) other.mesh = *mesh::make_plate({Vec3(0.24, 0.24, 0.011)}, 150);
    if (way == 4) other.program = "rhexis of tomorrow";
    if (way == 5) other.single_precision = true;
    EXPECT_THAT(refusal(other), HasSubstr("plate.h5.parts: what was computed there is of another record")) << way;
  }
  EXPECT_EQ(run(request, file).ending, Ending::complete);
  request.elastic.elastic.young *= 2.0;
  EXPECT_THAT(refusal(request), HasSubstr("plate.h5: there is a file of that name, and not of this record"));
}

TEST(Campaign, SaysThatItCannotBeLocked) {
  const fs::path file = fresh_folder("record-unlocked") / "plate.h5";
  fs::create_directories(file.string() + ".parts/merge");  // in the place of the lock's file
  const Expected<Campaign> campaign = Campaign::plan(test::plate(200, false));
  ASSERT_TRUE(campaign);
  const Expected<CampaignReport> report = campaign->run(file, {}, {});
  ASSERT_FALSE(report) << "nobody else is there to put the record together";
  EXPECT_THAT(report.error().message(), HasSubstr("plate.h5.parts/merge: cannot be locked"));
  EXPECT_FALSE(fs::exists(file));
}

TEST(Campaign, ChoosesTheAdvancesThatFit) {
  Expected<Campaign> campaign = Campaign::plan(test::plate(150, false));
  ASSERT_TRUE(campaign);
  const auto bytes = [&](int topologies) { return store::bytes_of_record(campaign->head(), topologies); };
  for (const auto& [advances, topologies] : {std::pair(1, 4), std::pair(2, 13), std::pair(3, 40)}) {
    ASSERT_TRUE(campaign->choose_advances(bytes(topologies)));
    EXPECT_EQ(campaign->head().parameters.advances, advances);
    EXPECT_EQ(campaign->topologies(), topologies);
    ASSERT_TRUE(campaign->choose_advances(bytes(topologies + 1)));
    EXPECT_EQ(campaign->head().parameters.advances, advances);
  }
  const Expected<void> none = campaign->choose_advances(bytes(3));
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message(), HasSubstr("a record of one advance takes"));
}

TEST(Campaign, ReadsItsRankFromWhoStartedIt) {
  const auto rank = [](std::initializer_list<std::pair<const char*, const char*>> variables) {
    for (const char* name :
         {"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE", "PMI_RANK", "PMI_SIZE", "SLURM_PROCID", "SLURM_NTASKS"})
      ::unsetenv(name);
    for (const auto& [name, value] : variables) ::setenv(name, value, 1);
    const Rank is = rank_of_this_process();
    return std::pair(is.rank, is.size);
  };
  EXPECT_EQ(rank({}), std::pair(0, 1));
  EXPECT_EQ(rank({{"OMPI_COMM_WORLD_RANK", "3"}, {"OMPI_COMM_WORLD_SIZE", "4"}}), std::pair(3, 4));
  EXPECT_EQ(rank({{"PMI_RANK", "1"}, {"PMI_SIZE", "2"}, {"SLURM_PROCID", "5"}}), std::pair(1, 2));
  EXPECT_EQ(rank({{"SLURM_PROCID", "5"}, {"SLURM_NTASKS", "8"}}), std::pair(5, 8));
  EXPECT_EQ(rank({{"SLURM_PROCID", "8"}, {"SLURM_NTASKS", "8"}}), std::pair(0, 1));  // makes no sense
  EXPECT_EQ(rank({{"SLURM_PROCID", "x"}, {"SLURM_NTASKS", "8"}}), std::pair(0, 1));
  rank({});
}

}  // namespace
}  // namespace rhexis::record::build
