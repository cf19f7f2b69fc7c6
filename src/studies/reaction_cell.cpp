#include "studies/reaction_cell.h"

#include <algorithm>
#include <array>
#include <memory>

#include "record/store/axis.h"
#include "record/store/operator.h"
#include "response/local_ritz.h"

namespace rhexis::studies {
namespace {

using record::build::FactoredState;

/// What is kept of a torn body once its factor has gone.
struct Torn {
  std::vector<double> angles;
  std::vector<Vec3> path;
  response::TornShape shape;
  std::vector<Mat3> stiffness;  ///< per grasp point
};

Vec3 front_of(const FactoredState& state) {
  Vec3 sum = Vec3::Zero();
  const std::vector<fracture::FrontPoint>& front = state.torn.cracks.front().front;
  for (const fracture::FrontPoint& point : front) sum += point.position;
  return sum / static_cast<double>(front.size());
}

/// Every torn body by the angles of `axes`, first advance first.
class Tearing {
 public:
  Tearing(const ReactionBody& body, const std::vector<std::vector<double>>& axes,
          std::function<void(const FactoredState&, Torn)> each)
      : body_(body), axes_(axes), each_(std::move(each)) {}
  void run() { run(*body_.first, {.angles = {}, .path = {front_of(*body_.first)}, .shape = {}, .stiffness = {}}); }

 private:
  void run(const FactoredState& state, const Torn& so_far) {
    const std::size_t level = so_far.angles.size();
    if (level == axes_.size()) {
      Torn torn = so_far;
      torn.shape = response::shape_of(state.torn.body.mesh());
      torn.stiffness = body_.recorder->stiffnesses(state);
      each_(state, std::move(torn));
      return;
    }
    for (const double angle : axes_[level]) {
      const FactoredState next = body_.recorder->advanced(state, body_.frame.direction(angle), body_.length);
      Torn torn = so_far;
      torn.angles.push_back(angle);
      torn.path.push_back(front_of(next));
      run(next, torn);
    }
  }

  const ReactionBody& body_;
  const std::vector<std::vector<double>>& axes_;
  std::function<void(const FactoredState&, Torn)> each_;
};

/// K^-1 of some dofs (rows) by those of every grasp point (columns), m/N.
Eigen::MatrixXd compliance_rows(const ReactionBody& body, const FactoredState& state,
                                const std::vector<std::int32_t>& dofs) {
  const record::build::OperatorLayout& layout = body.recorder->layout();
  const std::vector<std::int32_t>& points = body.recorder->points();
  Eigen::MatrixXd out(static_cast<Eigen::Index>(dofs.size()), 3 * static_cast<Eigen::Index>(points.size()));
  VectorX x(layout.pattern().rows());
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    x.setZero();
    x[layout.row_of()[static_cast<std::size_t>(dofs[i])]] = 1.0;
    record::store::solve_in_order<double>(layout.pattern(), state.factor.values(), x);
    for (std::size_t p = 0; p < points.size(); ++p) {
      for (std::size_t c = 0; c < 3; ++c)
        out(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(3 * p + c)) =
            x[layout.row_of()[3 * static_cast<std::size_t>(points[p]) + c]];
    }
  }
  return out;
}

/// A recorded corner of the cell.
struct Corner {
  Torn torn;
  FactoredState state;
};

/// Weight of each corner by (4.25), and the number of the nearest, (4.8).
struct Weights {
  std::vector<double> of;
  std::size_t nearest = 0;
};

Weights weights_of(const ReactionCell& cell, const std::vector<Corner>& corners, const std::vector<double>& angles) {
  Weights out;
  out.of.assign(corners.size(), 1.0);
  std::vector<bool> is_nearest(corners.size(), true);
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const std::array<double, 2> axis{cell.low[i], cell.high[i]};
    const record::store::Neighbours near = record::store::neighbours_on(axis, angles[i]);
    const double nearest = axis[static_cast<std::size_t>(record::store::nearest_on(axis, angles[i]))];
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const double at = corners[k].torn.angles[i];
      double weight = 0.0;  // both neighbours are the end where the angle is that
      for (std::size_t n = 0; n < 2; ++n)
        weight += axis[static_cast<std::size_t>(near.index[n])] == at ? near.weight[n] : 0.0;
      out.of[k] *= weight;
      is_nearest[k] = is_nearest[k] && at == nearest;
    }
  }
  out.nearest = static_cast<std::size_t>(std::find(is_nearest.begin(), is_nearest.end(), true) - is_nearest.begin());
  return out;
}

bool is_zero(const Mat3& stiffness) { return stiffness.isZero(0.0); }

}  // namespace

void visit_cell(const ReactionBody& body, const ReactionCell& cell,
                const std::function<void(const ReactionQuery&)>& visit) {
  std::vector<Corner> corners;
  std::vector<std::vector<double>> ends;
  for (std::size_t i = 0; i < cell.low.size(); ++i) ends.push_back({cell.low[i], cell.high[i]});
  Tearing(body, ends, [&](const FactoredState& state, Torn torn) {
    corners.push_back({std::move(torn), state});
  }).run();
  std::vector<Torn> torn;
  Tearing(body, cell.inside, [&](const FactoredState&, Torn one) { torn.push_back(std::move(one)); }).run();

  std::vector<const response::TornShape*> recorded;
  for (const Corner& corner : corners) recorded.push_back(&corner.torn.shape);
  std::vector<const response::TornShape*> all = recorded;
  for (const Torn& one : torn) all.push_back(&one.shape);
  const response::LocalRegion region(*body.mesh, body.recorder->model(), response::differing_tets(*body.mesh, all));
  const response::RecordedBodies bodies(region, recorded);
  std::vector<Eigen::MatrixXd> rows;
  for (const Corner& corner : corners) rows.push_back(compliance_rows(body, corner.state, region.dofs()));

  const std::vector<std::int32_t>& points = body.recorder->points();
  std::vector<std::optional<response::PointFields>> fields(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    std::vector<Eigen::MatrixXd> compliance;
    std::vector<Mat3> stiffness;
    bool there = true;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      compliance.emplace_back(rows[k].middleCols<3>(3 * static_cast<Eigen::Index>(p)));
      stiffness.push_back(corners[k].torn.stiffness[p]);
      there = there && !is_zero(stiffness.back());
    }
    if (there) fields[p] = bodies.fields(NodeId(points[p]), compliance, stiffness);
  }

  for (const Torn& one : torn) {
    const Weights weights = weights_of(cell, corners, one.angles);
    const response::LocalRitz ritz(region, one.shape);
    ReactionQuery query{one.angles, one.path, 0, {}};
    for (std::size_t p = 0; p < points.size(); ++p) {
      if (!fields[p] || is_zero(one.stiffness[p])) {
        ++query.torn_off;
        continue;
      }
      ReactionSample sample{p, one.stiffness[p], corners[weights.nearest].torn.stiffness[p], Mat3::Zero(),
                            ritz.stiffness(*fields[p])};
      for (std::size_t k = 0; k < corners.size(); ++k) sample.linear += weights.of[k] * corners[k].torn.stiffness[p];
      query.samples.push_back(sample);
    }
    visit(query);
  }
}

}  // namespace rhexis::studies
