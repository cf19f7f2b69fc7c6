#include "studies/full_solve.h"

#include <memory>
#include <vector>

#include "base/clock.h"
#include "element/linear_tet.h"
#include "linalg/cholesky_factor.h"
#include "linalg/null_pivot.h"
#include "linalg/one_thread.h"

extern "C" {
void dpotrf_(const char* uplo, const int* n, double* a, const int* lda, int* info);
void dpotri_(const char* uplo, const int* n, double* a, const int* lda, int* info);
}

namespace rhexis::studies {
namespace {

using linalg::SymmetricBlockMatrix;

/// Analysis and factorisation together are quicker with AMD's order up to this size, on plates, and with METIS's above.
constexpr std::size_t kAmdNodes = 10000;

struct FullStiffness {
  SymmetricBlockMatrix K;
  linalg::FreeDofs free;
};

/// Of the tets in the solve; nodes without one are held.
FullStiffness assemble(const mesh::TornMesh& body, const response::ElasticBody& elastic) {
  const mesh::TetMesh& mesh = body.mesh();
  std::vector<TetId> solved;
  std::vector<std::int32_t> connectivity;
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    if (!body.is_solved(TetId(t))) continue;
    solved.emplace_back(t);
    for (const NodeId node : mesh.tets[t]) connectivity.push_back(node.value());
  }
  const auto nodes = static_cast<std::int32_t>(mesh.node_count());
  SymmetricBlockMatrix K(std::make_shared<linalg::BlockPattern>(linalg::make_block_pattern(nodes, connectivity, 4)));

  Eigen::Matrix<double, 12, 12> element;
  for (const TetId tet : solved) {
    element::small_strain_stiffness(elastic.elastic, element::make_linear_tet(corners(mesh, tet)), element);
    const mesh::Tet& at = mesh.tet(tet);
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) {
        const std::int32_t row = at[static_cast<std::size_t>(a)].value();
        const std::int32_t column = at[static_cast<std::size_t>(b)].value();
        if (column > row) continue;
        const std::ptrdiff_t block = K.pattern->find(row, column);
        Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(K.values.data() + 9 * block) +=
            element.block<3, 3>(3 * a, 3 * b);
      }
    }
  }

  std::vector<bool> supported(3 * body.intact_node_count(), false);
  for (const model::PrescribedDof& support : elastic.supports) supported[static_cast<std::size_t>(support.dof)] = true;
  std::vector<bool> held(3 * mesh.node_count(), true);
  for (const std::int32_t node : connectivity) {
    const std::size_t to = 3 * static_cast<std::size_t>(node);
    const std::size_t from = 3 * body.original(NodeId(node)).index();
    for (std::size_t c = 0; c < 3; ++c) held[to + c] = supported[from + c];
  }
  return {std::move(K), linalg::make_free_dofs(held)};
}

/// The lower triangle, by columns.
Eigen::MatrixXd dense_lower(const FullStiffness& full) {
  const linalg::BlockPattern& pattern = *full.K.pattern;
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(full.free.count(), full.free.count());
  const double* value = full.K.values.data();
  for (std::int32_t row = 0; row < pattern.rows(); ++row) {
    for (std::int32_t at = pattern.row_start[static_cast<std::size_t>(row)];
         at < pattern.row_start[static_cast<std::size_t>(row) + 1]; ++at) {
      const std::int32_t column = pattern.column[static_cast<std::size_t>(at)];
      for (std::int32_t i = 0; i < 3; ++i) {
        for (std::int32_t j = 0; j < 3; ++j, ++value) {
          const std::int32_t to_row = full.free.index[static_cast<std::size_t>(3 * row + i)];
          const std::int32_t to_column = full.free.index[static_cast<std::size_t>(3 * column + j)];
          if (to_column >= 0 && to_column <= to_row) K(to_row, to_column) = *value;
        }
      }
    }
  }
  return K;
}

}  // namespace

std::optional<FullSolveSeconds> time_sparse_factor(const mesh::TornMesh& body, const response::ElasticBody& elastic) {
  FullSolveSeconds out;
  Stopwatch watch;
  const FullStiffness full = assemble(body, elastic);
  out.assembly = watch.seconds();

  watch.restart();
  linalg::CholeskyFactor factor(body.mesh().node_count() <= kAmdNodes ? linalg::Ordering::amd
                                                                      : linalg::Ordering::metis);
  if (factor.analyse(*full.K.pattern, full.free) != linalg::CholeskyOutcome::ok) return std::nullopt;
  out.analysis = watch.seconds();

  watch.restart();
  if (factor.factor(full.K.values) != linalg::CholeskyOutcome::ok) return std::nullopt;
  out.factor = watch.seconds();
  if (factor.smallest_pivot() < linalg::null_pivot(full.free.count())) return std::nullopt;
  return out;
}

std::optional<FullSolveSeconds> time_dense_inverse(const mesh::TornMesh& body, const response::ElasticBody& elastic) {
  linalg::stay_on_one_thread();
  FullSolveSeconds out;
  Stopwatch watch;
  Eigen::MatrixXd K = dense_lower(assemble(body, elastic));
  out.assembly = watch.seconds();

  watch.restart();
  const int n = static_cast<int>(K.rows());
  int info = 0;
  const VectorX diagonal = K.diagonal();
  dpotrf_("L", &n, K.data(), &n, &info);
  if (info != 0) return std::nullopt;
  if ((K.diagonal().array().square() < linalg::null_pivot(n) * diagonal.array()).any()) return std::nullopt;
  dpotri_("L", &n, K.data(), &n, &info);
  if (info != 0) return std::nullopt;
  out.factor = watch.seconds();
  return out;
}

}  // namespace rhexis::studies
