#pragma once

/// What the models on linear tets share: the space, the batches, the pattern of A, and the way from a state to kernels.

#include <functional>
#include <memory>

#include "element/tet_batches.h"
#include "element/tet_kernels.h"
#include "model/make_model.h"
#include "model/model.h"

namespace rhexis::model {

class P1Model : public Model {
 public:
  [[nodiscard]] const DisplacementSpace& space() const override { return space_; }
  [[nodiscard]] LeftOut left_out() const override { return left_out_; }
  [[nodiscard]] std::vector<double> tet_volumes() const override;
  [[nodiscard]] std::unique_ptr<Scratch> make_scratch() const override;
  [[nodiscard]] linalg::SaddleMatrix make_tangent() const override;
  [[nodiscard]] std::size_t memory_bytes() const override;

 protected:
  P1Model(const mesh::TetMesh& mesh, const element::TetKernels& kernels, LeftOut left_out);

  [[nodiscard]] std::size_t tet_count() const { return tet_count_; }
  [[nodiscard]] const element::TetBatches& batches() const { return batches_; }
  [[nodiscard]] const element::TetKernels& kernels() const { return kernels_; }

  /// Calls body(run) for every chunk, in parallel, with places that keep the blocks of each tet to itself: 10 t + pair.
  void for_each_chunk_apart(const std::function<void(const element::TetRun&)>& body) const;
  /// Sum of part(run) over the chunks, in one order whatever the threads.
  [[nodiscard]] double sum_over_chunks(const std::function<double(const element::TetRun&)>& part) const;
  /// The stiffness of small strains about rest, for the preconditioners.
  [[nodiscard]] linalg::SymmetricBlockMatrix small_strain_stiffness(double lame_lambda, double lame_mu) const;
  /// Calls visit(tet, F, J) for every tet that is not left out, in parallel.
  void for_each_tet(const VectorX& u, const std::function<void(std::size_t, const Mat3&, double)>& visit) const;
  /// Fills out.J and out.stress from the Cauchy stress of each tet, and its mean into out.lambda.
  [[nodiscard]] TetFields collect_fields(
      const VectorX& u, const std::function<Mat3(std::size_t tet, const Mat3& F, double J)>& cauchy) const;

 private:
  DisplacementSpace space_;
  std::size_t tet_count_ = 0;
  std::vector<std::uint8_t> left_out_;
  const element::TetKernels& kernels_;
  element::TetBatches batches_;
  std::shared_ptr<const linalg::BlockPattern> pattern_;  ///< of A
};

/// All values zero, on all threads.
void set_zero(std::vector<double>& values);

}  // namespace rhexis::model
