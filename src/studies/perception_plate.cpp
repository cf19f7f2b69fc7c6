#include "studies/perception_plate.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "studies/study_plate.h"

namespace rhexis::studies {
namespace {

constexpr int kThesisNodes = 506;

/// cos of the angle between the front and z.
constexpr double kAlongZ = 0.999;

Expected<session::SceneChoice> choose(const PerceptionSettings& settings) {
  if (settings.scene.empty())
    return session::SceneChoice{.file = "the plate of the thesis",
                                .text = plate_scene("The plate of the thesis", kThesisNodes),
                                .overrides = {}};
  return session::read_scene_choice(settings.scene.string(), {});
}

Expected<void> check(const session::OpenBody& body) {
  const std::string& file = body.scene.file;
  if (body.problem.tears)
    return fail("the body of an experiment does not tear by itself", "leave [fracture] out", file);
  if (body.problem.interaction.response != "exact")
    return fail("a record knows some crack angles only", "response = \"exact\"", file);
  if (!body.tear().is_linear())  // a trial is felt by one law, as far as one may pull
    return fail(fmt::format("a plate of model '{}' has another law at every pull", body.tear().model_name()),
                "kind = \"linear\"", file);
  const std::vector<fracture::Crack>& cracks = body.tear().cracks();
  if (cracks.empty() || cracks.back().finished) return fail("no crack can run on", "add a [[crack]]", file);
  for (const fracture::FrontPoint& point : cracks.back().front)
    if (std::abs(point.tangent.z()) < kAlongZ)
      return body.problem.cracks.back().place.fail("the crack does not go through along z, about which its angle is",
                                                   "through = [0.0, 0.0, 1.0]");
  return {};
}

}  // namespace

Expected<PerceptionPlate> PerceptionPlate::open(const PerceptionSettings& settings) {
  Expected<session::SceneChoice> choice = choose(settings);
  if (!choice) return fail(std::move(choice.error()));
  Expected<std::unique_ptr<session::OpenBody>> body = session::open_body(std::move(*choice));
  if (!body) return fail(std::move(body.error()));
  if (Expected<void> good = check(**body); !good) return fail(std::move(good.error()));
  PerceptionPlate plate(settings, std::move(*body));
  if (const auto sample = plate.laws(settings.sample); !sample) return fail(sample.error());
  return plate;
}

Expected<std::unique_ptr<session::OpenBody>> PerceptionPlate::torn(double angle) const {
  Expected<std::unique_ptr<session::OpenBody>> body = session::reopen(*intact_);
  if (!body) return body;
  session::TearSession& tear = (*body)->tear();
  const double radians = angle * std::numbers::pi / 180.0;
  const session::TickReport report =
      tear.impose(tear.cracks().size() - 1, Vec3(std::cos(radians), std::sin(radians), 0.0), length_);
  if (report.advances == 0)
    return fail(fmt::format("the crack does not run on by {} m at {} degrees{}{}", length_, angle,
                            report.trouble.empty() ? "" : ": ", report.trouble),
                "another 'crack.length'", intact_->scene.file);
  (*body)->surface = session::SurfaceTracker(tear.body());
  (*body)->first_topology = tear.body().topology();
  (*body)->advance_time.assign(tear.advances().size(), 0.0);
  (*body)->fingerprint = session::chained((*body)->fingerprint, tear.body().history().back(), /*taken_back=*/false);
  return body;
}

Expected<std::vector<response::ContactLaw>> PerceptionPlate::laws(double angle) const {
  const Expected<std::unique_ptr<session::OpenBody>> body = torn(angle);
  if (!body) return fail(body.error());
  session::TearSession& tear = (*body)->tear();
  std::vector<response::ContactLaw> out;
  for (const PlacedVector& point : points_) {
    if (const Expected<void> holds = tear.grasp(point.value); !holds)
      return point.place.fail(holds.error().what, holds.error().remedy);
    out.push_back(tear.hand().law());
  }
  return out;
}

}  // namespace rhexis::studies
