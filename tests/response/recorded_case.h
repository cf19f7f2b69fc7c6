#pragma once

/// A coarse plate, its record, and its body torn as any topology of the record.

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "response/contact.h"
#include "response/exact_response.h"
#include "response/recorded_response.h"
#include "tests/record/build/recorded_plate.h"

namespace rhexis::response::test {

struct RecordedCase {
  record::build::CampaignRequest request;
  SharedRecord record;

  /// Thirteen topologies, or so many as `advances` make.
  static RecordedCase make(bool loaded, int advances = 2) {
    RecordedCase out;
    out.request = record::build::test::plate(300, loaded);
    out.request.parameters.advances = advances;
    const std::filesystem::path file = std::filesystem::path(testing::TempDir()) /
                                       ("response-" + std::to_string(::getpid()) + (loaded ? "l" : "u") + ".h5");
    const auto campaign = record::build::Campaign::plan(out.request);
    EXPECT_TRUE(campaign.has_value());
    EXPECT_TRUE(campaign->run(file, {}, {}).has_value());
    auto read = record::store::LoadedRecord::read(file);
    EXPECT_TRUE(read.has_value()) << read.error().message();
    out.record = *read;
    std::filesystem::remove(file);
    return out;
  }
  static const RecordedCase& plate(bool loaded) {
    static const RecordedCase free = make(false);
    static const RecordedCase under_load = make(true);
    return loaded ? under_load : free;
  }

  [[nodiscard]] record::store::Numbering numbering() const {
    return record::store::Numbering(record->head().parameters);
  }
  [[nodiscard]] int topologies() const { return numbering().count(); }
  [[nodiscard]] CrackAdvance advance(double degrees, double length = 0.0403) const {
    return {.crack = 0, .started = false, .direction = record->head().frame.direction(degrees), .length = length};
  }
  [[nodiscard]] std::vector<CrackAdvance> advances_to(int number) const {
    std::vector<CrackAdvance> out;
    for (const record::store::Choice& choice : numbering().choices(number))
      out.push_back(advance(
          record::store::direction_angles(record->head().parameters)[static_cast<std::size_t>(choice.direction)],
          record->head().parameters.lengths[static_cast<std::size_t>(choice.length)]));
    return out;
  }
  [[nodiscard]] record::build::TornState torn(int number) const { return record::build::test::torn(request, number); }
  [[nodiscard]] std::unique_ptr<Response> exact(const mesh::TornMesh& body) const {
    ExactSettings settings;
    settings.body = request.elastic;
    return ExactResponse::make(body, std::move(settings), {});
  }
  [[nodiscard]] std::unique_ptr<RecordedResponse> recorded(const mesh::TornMesh& body,
                                                           const std::vector<CrackAdvance>& advances) const {
    return std::make_unique<RecordedResponse>(body, record, request.elastic, advances);
  }
};

/// The nodes of the surface point nearest to `at`: one to three.
inline SurfacePoint point_at(const mesh::TornMesh& body, const Vec3& at, double snap = 0.0) {
  return *nearest_surface_point(body, at, snap);
}
inline std::span<const NodeId> nodes_of(const SurfacePoint& point) {
  return {point.node.data(), static_cast<std::size_t>(point.count)};
}

}  // namespace rhexis::response::test
