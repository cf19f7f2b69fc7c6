#pragma once

/// Deformed bodies side by side as one SVG, seen as the page first shows them: for print, and where there is no WebGL.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/ids.h"
#include "base/vec.h"
#include "mesh/tet_mesh.h"

namespace rhexis::result {

/// What is seen of a body: its boundary, with nodes of its own numbering.
struct ShapeSurface {
  std::vector<Vec3> nodes;                         ///< reference position, m
  std::vector<std::array<std::int32_t, 3>> faces;  ///< counter-clockwise seen from outside
  std::vector<NodeId> node;                        ///< of the mesh, per node
  std::vector<TetId> tet;                          ///< of the mesh, behind each face
};
[[nodiscard]] ShapeSurface surface_of(const mesh::TetMesh& mesh);

struct ShapePanel {
  std::string title = {};
  std::vector<Vec3> displacement = {};  ///< m, per node of the surface
  std::vector<double> values = {};      ///< per face, in the picture's unit; empty: grey
};

struct ShapePicture {
  std::string title = {};
  std::string subtitle = {};
  ShapeSurface surface = {};
  std::vector<ShapePanel> panels = {};
  std::string field = {};  ///< what the colours are
  std::string unit = {};   ///< "Pa" or "m"
  bool has_sign = false;   ///< colours from -top to top, else from 0
};

/// The value of the last colour: a round number that 98 of 100 values do not exceed; 0 where nothing is coloured.
[[nodiscard]] double top_of(const ShapePicture& picture);

/// The lines of the reference shape lie behind each body. The same picture gives the same bytes.
[[nodiscard]] std::string shape_svg(const ShapePicture& picture);

}  // namespace rhexis::result
