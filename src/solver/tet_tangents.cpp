#include "solver/tet_tangents.h"

#include <algorithm>

#include "solver/inertia.h"

namespace rhexis::solver {
namespace {

using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using Block = Eigen::Map<RowMajor>;

}  // namespace

TetTangents::TetTangents(const model::Model& model, const linalg::FreeDofs& free, const model::State& state,
                         double inertia)
    : inertia_(inertia) {
  const auto scratch = model.make_scratch();
  model.tet_tangents(state, *scratch, blocks_, coupling_);
  take_nodes(model, free);
}

void TetTangents::follow(const model::Model& model, const linalg::FreeDofs& free, const model::State& state,
                         std::span<const std::int32_t> touched, const std::vector<Mat3>& T) {
  std::vector<double> blocks;
  std::vector<double> coupling;
  const auto scratch = model.make_scratch();
  model.tet_tangents(state, *scratch, blocks, coupling);
  take_nodes(model, free);
  for (const std::int32_t tet : touched) {
    const auto t = static_cast<std::size_t>(tet);
    const auto turn = [&](std::size_t a) -> const Mat3& { return T[static_cast<std::size_t>(nodes_[t][a])]; };
    std::size_t at = 90 * t;
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b <= a; ++b, at += 9)
        Block(blocks_.data() + at) = turn(a).transpose() * Block(blocks.data() + at) * turn(b);
    }
    for (std::size_t a = 0; a < 4 && !coupling.empty(); ++a) {
      const std::size_t of = 12 * t + 3 * a;
      Eigen::Map<Vec3>(coupling_.data() + of) = turn(a).transpose() * Eigen::Map<Vec3>(coupling.data() + of);
    }
  }
}

void TetTangents::stiffness(std::int32_t tet, linalg::ElementMatrix& out) const {
  const double* block = blocks_.data() + 90 * static_cast<std::size_t>(tet);
  for (Eigen::Index a = 0; a < 4; ++a) {
    for (Eigen::Index b = 0; b <= a; ++b, block += 9) {
      const Eigen::Map<const RowMajor> K(block);
      out.block<3, 3>(3 * a, 3 * b) = K;
      out.block<3, 3>(3 * b, 3 * a) = K.transpose();
    }
  }
  if (!coupling_.empty()) {
    const Eigen::Map<const linalg::ElementVector> b(coupling_.data() + 12 * static_cast<std::size_t>(tet));
    out.noalias() += b * b.transpose() / d_[tet];
  }
  if (!mass_.empty()) out.diagonal().array() += 0.25 * mass_[static_cast<std::size_t>(tet)];
  if (shift_ > 0.0) out.diagonal().array() += shift_ * out.diagonal().cwiseAbs().mean();
}

std::size_t TetTangents::memory_bytes() const {
  return sizeof(double) * (blocks_.size() + coupling_.size()) + sizeof(nodes_[0]) * nodes_.size();
}

void TetTangents::take_nodes(const model::Model& model, const linalg::FreeDofs& free) {
  const std::vector<std::int32_t>& connectivity = model.space().connectivity;
  nodes_.resize(connectivity.size() / 4);
  for (std::size_t t = 0; t < nodes_.size(); ++t) {
    std::copy_n(connectivity.begin() + static_cast<std::ptrdiff_t>(4 * t), 4, nodes_[t].begin());
    std::sort(nodes_[t].begin(), nodes_[t].end());
  }
  const std::span<const std::uint8_t> out = model.left_out();
  left_out_.assign(out.begin(), out.end());
  free_.assign(model.space().node_count(), 0);
  for (const std::int32_t dof : free.dof) free_[static_cast<std::size_t>(dof / 3)] |= 1U << (dof % 3);
  if (inertia_ > 0.0) mass_ = tet_masses(model, inertia_);
}

}  // namespace rhexis::solver
