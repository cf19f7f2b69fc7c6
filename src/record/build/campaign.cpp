#include "record/build/campaign.h"

#include <utility>

#include "base/hash.h"
#include "record/build/campaign_run.h"
#include "record/store/record_writer.h"

namespace rhexis::record::build {
namespace {

/// Counts the changes of this room, or of what it stands on, that change what a record says: parts and records of other
/// counts are not taken up.
constexpr std::uint64_t kMethod = 1;

std::span<const double> numbers(const Vec3& v) { return {v.data(), 3}; }
template <class Value>
std::span<const Value> one(const Value& value) {
  return {&value, 1};
}

}  // namespace

std::uint64_t fingerprint_of(const CampaignRequest& request) {
  const response::ElasticBody& body = request.elastic;
  Hash hash;
  hash.add(one(kMethod)).add(std::span<const char>(request.program));
  for (const Vec3& x : request.mesh.nodes) hash.add(numbers(x));
  for (const mesh::Tet& tet : request.mesh.tets)
    for (const NodeId node : tet) hash.add(one(node.value()));
  for (const double value : {body.elastic.young, body.elastic.poisson, body.density}) hash.add(one(value));
  hash.add(numbers(body.gravity));
  for (const model::PrescribedDof& support : body.supports) hash.add(one(support.dof)).add(one(support.value));
  hash.add(std::span<const double>(body.dead_force.data(), static_cast<std::size_t>(body.dead_force.size())));
  hash.add(numbers(request.crack.from)).add(numbers(request.crack.to)).add(numbers(request.crack.through));
  const store::Parameters& parameters = request.parameters;
  for (const int value : {parameters.advances, parameters.directions, parameters.pull_directions}) hash.add(one(value));
  hash.add(std::span<const double>(parameters.lengths)).add(one(parameters.pull_length));
  return hash.add(one(request.single_precision)).value();
}

Campaign::Campaign(CampaignRequest request, std::unique_ptr<const Recorder> recorder, FactoredState first)
    : request_(std::move(request)), recorder_(std::move(recorder)), first_(std::move(first)) {
  head_.frame = frame_of(request_.crack);
  head_.program = request_.program;
  head_.title = request_.title;
  recorder_->describe(head_);
  take_parameters();
}

void Campaign::take_parameters() {
  head_.parameters = request_.parameters;
  head_.fingerprint = fingerprint_of(request_);
}

Expected<Campaign> Campaign::plan(CampaignRequest request) {
  Expected<TornState> torn = TornState::begin(request.mesh, request.elastic, request.crack);
  if (!torn) return fail(std::move(torn.error()));
  auto recorder = std::make_unique<const Recorder>(request.mesh, request.elastic, request.single_precision);
  FactoredState first{std::move(*torn), OperatorFactor(recorder->layout())};
  if (!recorder->factor(first))
    return fail("the cracked body is not stable: a part of it can move freely", "hold it by another [[support]]");
  return Campaign(std::move(request), std::move(recorder), std::move(first));
}

Expected<void> Campaign::choose_advances(double bytes) {
  store::Parameters parameters = request_.parameters;
  int most = 0;
  double least = 0.0;
  for (parameters.advances = 1; parameters.advances <= store::kMostAdvances; ++parameters.advances) {
    const std::int64_t count = store::Numbering::count_of(parameters);
    const double needed = store::bytes_of_record(head_, static_cast<double>(count));
    if (parameters.advances == 1) least = needed;
    if (count > store::kMostTopologies || needed > bytes) break;
    most = parameters.advances;
  }
  if (most == 0)
    return fail(fmt::format("a record of one advance takes {:.1f} MB", 1e-6 * least),
                "more memory, or fewer directions or lengths in [record]");
  request_.parameters.advances = most;
  take_parameters();
  return {};
}

FactoredState Campaign::follow(const FactoredState& before, int number) const {
  const store::Parameters& parameters = head_.parameters;
  const store::Choice last = store::Numbering(parameters).choices(number).back();
  const double angle = store::direction_angles(parameters)[static_cast<std::size_t>(last.direction)];
  return recorder_->advanced(before, head_.frame.direction(angle),
                             parameters.lengths[static_cast<std::size_t>(last.length)]);
}

Expected<CampaignReport> Campaign::run(const std::filesystem::path& file, Rank rank, const Observer& observe) const {
  return CampaignRun(*this, file, rank, observe).run();
}

}  // namespace rhexis::record::build
