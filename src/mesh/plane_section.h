#pragma once

/// Cross-sections of plates and tubes, filled with an exact number of points and well-shaped, unstructured triangles.

#include <optional>
#include <vector>

#include "mesh/triangulation.h"

namespace rhexis::mesh {

enum class Rim : char { none, outer, inner };

struct PlaneMesh {
  std::vector<Point2> points;       ///< m
  std::vector<Triangle> triangles;  ///< counter-clockwise
  std::vector<Rim> rim;             ///< of each point: on which line that bounds the section it lies
};

class PlaneSection {
 public:
  virtual ~PlaneSection() = default;
  /// Edge length, m, of the triangles when the section holds this many points; none when too few for its form.
  [[nodiscard]] virtual std::optional<double> edge_length(int points) const = 0;
  /// For counts that have an edge length.
  [[nodiscard]] virtual PlaneMesh mesh(int points) const = 0;
};

/// [0, a] x [0, b]. Rim points lie on the sides to the last bit.
class RectangleSection final : public PlaneSection {
 public:
  RectangleSection(double a, double b) : a_(a), b_(b) {}
  [[nodiscard]] std::optional<double> edge_length(int points) const override;
  [[nodiscard]] PlaneMesh mesh(int points) const override;

 private:
  double a_;
  double b_;
};

/// A disc around the origin, its rim an inscribed regular polygon.
class DiscSection final : public PlaneSection {
 public:
  explicit DiscSection(double radius) : radius_(radius) {}
  [[nodiscard]] std::optional<double> edge_length(int points) const override;
  [[nodiscard]] PlaneMesh mesh(int points) const override;

 private:
  double radius_;
};

/// The region between two circles around the origin, both replaced by inscribed regular polygons.
class AnnulusSection final : public PlaneSection {
 public:
  AnnulusSection(double outer, double inner) : outer_(outer), inner_(inner) {}
  [[nodiscard]] std::optional<double> edge_length(int points) const override;
  [[nodiscard]] PlaneMesh mesh(int points) const override;

 private:
  double outer_;
  double inner_;
};

}  // namespace rhexis::mesh
