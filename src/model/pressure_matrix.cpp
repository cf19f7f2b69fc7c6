#include "model/pressure_matrix.h"

#include <algorithm>
#include <memory>

#include "mesh/surface.h"

namespace rhexis::model {

linalg::SymmetricCsr make_pressure_matrix(const mesh::TetMesh& mesh, double kappa, double beta, LeftOut left_out) {
  const auto is_out = [&](std::size_t t) { return !left_out.empty() && left_out[t] != 0; };
  struct Jump {
    std::int32_t row, col;  ///< row > col
    double factor;
  };
  std::vector<Jump> jumps;
  if (beta > 0.0) {
    std::vector<double> h(mesh.tet_count());
    for (std::size_t t = 0; t < h.size(); ++t) h[t] = mesh::longest_edge(mesh, TetId(t));
    const mesh::FaceTable faces = mesh::find_faces(mesh);
    jumps.reserve(faces.interior.size());
    for (const mesh::InteriorFace& face : faces.interior) {
      const TetId a = face.first.tet, b = face.second.tet;
      if (is_out(a.index()) || is_out(b.index())) continue;
      const double factor = beta * (h[a.index()] + h[b.index()]) * mesh::face_area(mesh, face.first) / kappa;
      jumps.push_back({std::max(a, b).value(), std::min(a, b).value(), factor});
    }
    std::sort(jumps.begin(), jumps.end(),
              [](const Jump& x, const Jump& y) { return std::pair(x.row, x.col) < std::pair(y.row, y.col); });
  }

  auto pattern = std::make_shared<linalg::CsrPattern>();
  pattern->row_start.push_back(0);
  std::size_t next = 0;
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    const auto row = static_cast<std::int32_t>(t);
    for (; next < jumps.size() && jumps[next].row == row; ++next) pattern->column.push_back(jumps[next].col);
    pattern->column.push_back(row);
    pattern->row_start.push_back(static_cast<std::int32_t>(pattern->column.size()));
  }

  linalg::SymmetricCsr C(pattern);
  const auto diagonal = [&](std::size_t row) -> double& {
    return C.values[static_cast<std::size_t>(pattern->row_start[row + 1]) - 1];
  };
  double whole = 0.0;
  std::size_t count = 0;
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    if (is_out(t)) continue;
    diagonal(t) = mesh::signed_volume(mesh, TetId(t)) / kappa;
    whole += diagonal(t);
    ++count;
  }
  // The lambda of a tet left out is in no equation but its own, where any number does; its volume is not read, which
  // nobody keeps above zero any more.
  const double mean = count > 0 ? whole / static_cast<double>(count) : 1.0 / kappa;
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    if (is_out(t)) diagonal(t) = mean;
  }
  next = 0;
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    auto at = static_cast<std::size_t>(pattern->row_start[t]);
    for (; next < jumps.size() && jumps[next].row == static_cast<std::int32_t>(t); ++next) {
      C.values[at++] = -jumps[next].factor;
      diagonal(t) += jumps[next].factor;
      diagonal(static_cast<std::size_t>(jumps[next].col)) += jumps[next].factor;
    }
  }
  return C;
}

}  // namespace rhexis::model
