#include "model/p1_model.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "base/parallel.h"
#include "model/evaluation.h"

namespace rhexis::model {
namespace {

constexpr std::size_t kZeroGrain = std::size_t{1} << 16;
constexpr std::size_t kBatchGrain = 128;

}  // namespace

void set_zero(std::vector<double>& values) {
  parallel_ranges(values.size(), kZeroGrain, [&](std::size_t begin, std::size_t end) {
    std::fill(values.begin() + static_cast<std::ptrdiff_t>(begin), values.begin() + static_cast<std::ptrdiff_t>(end),
              0.0);
  });
}

P1Model::P1Model(const mesh::TetMesh& mesh, const element::TetKernels& kernels, LeftOut left_out)
    : space_(make_p1_space(mesh)),
      tet_count_(mesh.tet_count()),
      left_out_(left_out.begin(), left_out.end()),
      kernels_(kernels),
      batches_(mesh, left_out),
      pattern_(std::make_shared<linalg::BlockPattern>(
          linalg::make_block_pattern(static_cast<std::int32_t>(mesh.node_count()), space_.connectivity, 4))) {
  batches_.place_blocks(*pattern_);
}

std::unique_ptr<Scratch> P1Model::make_scratch() const {
  auto scratch = std::make_unique<Scratch>();
  scratch->J.setOnes(static_cast<Eigen::Index>(tet_count_));
  return scratch;
}

linalg::SaddleMatrix P1Model::make_tangent() const {
  linalg::SaddleMatrix out;
  out.A = linalg::SymmetricBlockMatrix(pattern_);
  return out;
}

std::size_t P1Model::memory_bytes() const {
  return space_.nodes.size() * sizeof(Vec3) + space_.connectivity.size() * sizeof(std::int32_t) +
         batches_.memory_bytes() + (pattern_->row_start.size() + pattern_->column.size()) * sizeof(std::int32_t);
}

void P1Model::for_each_chunk_apart(const std::function<void(const element::TetRun&)>& body) const {
  batches_.for_each_chunk([&](const element::TetRun& run, std::size_t) {
    std::vector<element::BlockPlaces> apart(static_cast<std::size_t>(run.count));
    for (std::size_t i = 0; i < apart.size(); ++i) {
      for (int pair = 0; pair < 10; ++pair) {
        for (int lane = 0; lane < element::kBatch; ++lane)
          apart[i].block[pair][lane] = 10 * run.batches[i].tet[lane] + pair;
      }
    }
    body({run.batches, apart.data(), run.count});
  });
}

double P1Model::sum_over_chunks(const std::function<double(const element::TetRun&)>& part) const {
  std::vector<double> parts(batches_.chunk_count());
  batches_.for_each_chunk([&](const element::TetRun& run, std::size_t chunk) { parts[chunk] = part(run); });
  double sum = 0.0;
  for (const double value : parts) sum += value;
  return sum;
}

linalg::SymmetricBlockMatrix P1Model::small_strain_stiffness(double lame_lambda, double lame_mu) const {
  linalg::SymmetricBlockMatrix out(pattern_);
  const VectorX rest = VectorX::Zero(static_cast<Eigen::Index>(space_.dof_count()));
  VectorX J(static_cast<Eigen::Index>(tet_count_));
  const element::SmallStrain response{lame_lambda, lame_mu};
  batches_.for_each_chunk([&](const element::TetRun& run, std::size_t) {
    kernels_.linear.tangent(response, run, rest.data(), out.values.data(), J.data());
  });
  return out;
}

std::vector<double> P1Model::tet_volumes() const {
  std::vector<double> out(tet_count_, 0.0);
  for (const element::TetBatch& batch : batches_.batches())
    for (int lane = 0; lane < batch.count; ++lane) out[static_cast<std::size_t>(batch.tet[lane])] = batch.volume[lane];
  return out;
}

void P1Model::for_each_tet(const VectorX& u, const std::function<void(std::size_t, const Mat3&, double)>& visit) const {
  const std::vector<element::TetBatch>& all = batches_.batches();
  parallel_ranges(all.size(), kBatchGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const element::TetBatch& batch = all[i];
      for (int lane = 0; lane < batch.count; ++lane) {
        Mat3 F = Mat3::Identity();
        const Vec3 origin = u.segment<3>(3 * batch.node[0][lane]);
        for (int a = 0; a < 3; ++a) {
          const Vec3 gradient(batch.gradient[3 * a][lane], batch.gradient[3 * a + 1][lane],
                              batch.gradient[3 * a + 2][lane]);
          F += (u.segment<3>(3 * batch.node[a + 1][lane]) - origin) * gradient.transpose();
        }
        visit(static_cast<std::size_t>(batch.tet[lane]), F, F.determinant());
      }
    }
  });
}

TetFields P1Model::collect_fields(const VectorX& u,
                                  const std::function<Mat3(std::size_t, const Mat3&, double)>& cauchy) const {
  TetFields out = make_tet_fields(tet_count_);
  for_each_tet(u, [&](std::size_t tet, const Mat3& F, double J) {
    const Mat3 stress = cauchy(tet, F, J);
    set_tet(out, tet, J, stress.trace() / 3.0, stress);
  });
  return out;
}

}  // namespace rhexis::model
