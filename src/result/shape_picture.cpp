#include "result/shape_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "base/check.h"
#include "mesh/io/xml_text.h"
#include "mesh/surface.h"
#include "result/svg_writer.h"

namespace rhexis::result {
namespace {

using mesh::io::xml_escaped;

constexpr double kWidth = 860.0;       // px, of the figure
constexpr double kMargin = 16.0;       // px
constexpr double kMostHeight = 400.0;  // px, of a panel
constexpr std::size_t kColumns = 4;
constexpr double kHeading = 64.0;     // px
constexpr double kPanelTitle = 26.0;  // px
constexpr double kLegend = 46.0;      // px
constexpr double kShare = 0.98;       // of the values that the colours have to tell apart
constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kYaw = -30.0 * kDegree;  // as the page's CameraRig begins
constexpr double kPitch = 18.0 * kDegree;

/// Even steps of the ramps of the page (viewer/src/colour/ramp.ts), for what grows from nothing and for what has a
/// sign.
using Rgb = std::array<double, 3>;
constexpr std::array<std::uint32_t, 11> kSequential{0x3a1463, 0x342f80, 0x1d4b96, 0x006799, 0x007f9b, 0x00979d,
                                                    0x00b09a, 0x42c68b, 0x8ad679, 0xc7e16b, 0xffea6b};
constexpr std::array<std::uint32_t, 11> kDiverging{0x004b96, 0x1366c0, 0x4c85ce, 0x7aa4d9, 0xa9c1e1, 0xdedede,
                                                   0xdfb3ac, 0xd48b81, 0xc46358, 0xb1372f, 0x950007};
constexpr Rgb kGrey{152.0, 160.0, 170.0};

Rgb colour_of(const ShapePicture& picture, double value, double top) {
  const std::array<std::uint32_t, 11>& stops = picture.has_sign ? kDiverging : kSequential;
  const double part = top > 0.0 ? (picture.has_sign ? 0.5 + 0.5 * value / top : value / top) : 0.0;
  const double at = 10.0 * std::clamp(part, 0.0, 1.0);
  const auto low = std::min<std::size_t>(static_cast<std::size_t>(at), 9);
  Rgb out;
  for (std::size_t c = 0; c < 3; ++c) {
    const auto component = [&](std::size_t stop) { return static_cast<double>((stops[stop] >> (16 - 8 * c)) & 255U); };
    out[c] = std::lerp(component(low), component(low + 1), at - static_cast<double>(low));
  }
  return out;
}

/// Across, up and towards the eye; parallel light rays and an eye far away.
Vec3 seen(const Vec3& x) {
  static const Vec3 kForward(-std::sin(kYaw) * std::cos(kPitch), std::cos(kYaw) * std::cos(kPitch), -std::sin(kPitch));
  static const Vec3 kRight = kForward.cross(Vec3::UnitZ()).normalized();
  static const Vec3 kUp = kRight.cross(kForward);
  return {kRight.dot(x), kUp.dot(x), -kForward.dot(x)};
}

struct Frame {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = Vec3::Constant(-std::numeric_limits<double>::infinity());
  void take(const Vec3& x) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
};

class Picture : private SvgWriter {
 public:
  explicit Picture(const ShapePicture& picture) : picture_(picture), top_(top_of(picture)) {
    for (const Vec3& x : picture.surface.nodes) reference_.push_back(seen(x));
    for (const Vec3& x : reference_) frame_.take(x);
    for (const ShapePanel& panel : picture.panels)
      for (std::size_t n = 0; n < reference_.size(); ++n) frame_.take(reference_[n] + seen(panel.displacement[n]));
  }

  std::string draw() {
    const std::size_t count = picture_.panels.size();
    const std::size_t columns = std::min(kColumns, count);
    const std::size_t rows = (count + columns - 1) / columns;
    const double cell = (kWidth - 2.0 * kMargin) / static_cast<double>(columns);
    const Vec3 size = frame_.high - frame_.low;
    scale_ = std::min((cell - 12.0) / size.x(), kMostHeight / size.y());
    const double height = scale_ * size.y() + kPanelTitle + 10.0;
    const double all = kHeading + height * static_cast<double>(rows) + (top_ > 0.0 ? kLegend : 0.0) + kMargin;
    open(all);
    for (std::size_t k = 0; k < count; ++k) {
      const double left = kMargin + cell * static_cast<double>(k % columns);
      const double down = kHeading + height * static_cast<double>(k / columns);
      panel(picture_.panels[k], left + 0.5 * (cell - scale_ * size.x()), down + kPanelTitle);
      text(left + 0.5 * cell, down + 14.0, "middle", picture_.panels[k].title);
    }
    if (top_ > 0.0) legend(all - kLegend);
    out_ += "</svg>\n";
    return std::move(out_);
  }

 private:
  void open(double height) {
    add("<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"rhexis-shapes\" viewBox=\"0 0 {0:.0f} {1:.0f}\" "
        "width=\"{0:.0f}\" height=\"{1:.0f}\" role=\"img\">\n<title>{2}</title>\n",
        kWidth, height, xml_escaped(picture_.title));
    out_ +=
        "<style>\n"
        ".rhexis-shapes text{font:12px system-ui,-apple-system,\"Segoe UI\",Roboto,\"Helvetica Neue\",Arial,\"DejaVu "
        "Sans\",sans-serif;fill:#1f2328} .rhexis-shapes .title{font-size:16px;font-weight:600} "
        ".rhexis-shapes .middle{text-anchor:middle} .rhexis-shapes .end{text-anchor:end}\n"
        ".rhexis-shapes .ground{fill:#fff} .rhexis-shapes .faint{fill:#59636e} "
        ".rhexis-shapes .rest{fill:none;stroke:#59636e;stroke-width:.5;opacity:.45} "
        ".rhexis-shapes polygon{stroke-width:.35;stroke:#3c444e;stroke-linejoin:round}\n"
        "@media (prefers-color-scheme:dark){.rhexis-shapes text{fill:#e6edf3} .rhexis-shapes .faint{fill:#9198a1} "
        ".rhexis-shapes .ground{fill:#0d1117} .rhexis-shapes .rest{stroke:#9198a1} "
        ".rhexis-shapes polygon{stroke:#0c0f12}}\n</style>\n";
    add("<rect class=\"ground\" width=\"{:.0f}\" height=\"{:.0f}\"/>\n", kWidth, height);
    text(kMargin, kMargin + 16.0, "title", picture_.title);
    text(kMargin, kMargin + 36.0, "faint", picture_.subtitle);
  }

  [[nodiscard]] Eigen::Vector2d place(const Vec3& x, double left, double top) const {
    return {left + scale_ * (x.x() - frame_.low.x()), top + scale_ * (frame_.high.y() - x.y())};
  }

  void panel(const ShapePanel& panel, double left, double top) {
    const ShapeSurface& surface = picture_.surface;
    std::set<std::pair<std::int32_t, std::int32_t>> edges;
    for (const auto& face : surface.faces)
      for (std::size_t k = 0; k < 3; ++k) edges.insert(std::minmax(face[k], face[(k + 1) % 3]));
    out_ += "<path class=\"rest\" d=\"";
    for (const auto& [a, b] : edges) {
      const Eigen::Vector2d from = place(reference_[static_cast<std::size_t>(a)], left, top);
      const Eigen::Vector2d to = place(reference_[static_cast<std::size_t>(b)], left, top);
      add("M{:.1f} {:.1f}L{:.1f} {:.1f}", from.x(), from.y(), to.x(), to.y());
    }
    out_ += "\"/>\n";

    std::vector<Vec3> at;
    for (std::size_t n = 0; n < reference_.size(); ++n) at.push_back(reference_[n] + seen(panel.displacement[n]));
    struct Drawn {
      double depth;
      std::size_t face;
    };
    std::vector<Drawn> drawn;
    for (std::size_t f = 0; f < surface.faces.size(); ++f) {
      double depth = 0.0;
      for (const std::int32_t n : surface.faces[f]) depth += at[static_cast<std::size_t>(n)].z();
      drawn.push_back({depth, f});
    }
    std::stable_sort(drawn.begin(), drawn.end(), [](const Drawn& a, const Drawn& b) { return a.depth < b.depth; });
    for (const Drawn& one : drawn) {
      const auto& [a, b, c] = surface.faces[one.face];
      const Vec3& first = at[static_cast<std::size_t>(a)];
      const Vec3 normal =
          (at[static_cast<std::size_t>(b)] - first).cross(at[static_cast<std::size_t>(c)] - first).normalized();
      const bool inside = !(normal.z() > 0.0);
      const double light = (0.62 + 0.38 * std::abs(normal.z())) * (inside ? 0.72 : 1.0);
      const Rgb colour = panel.values.empty() ? kGrey : colour_of(picture_, panel.values[one.face], top_);
      out_ += "<polygon points=\"";
      for (const std::int32_t n : surface.faces[one.face]) {
        const Eigen::Vector2d corner = place(at[static_cast<std::size_t>(n)], left, top);
        add("{:.1f},{:.1f} ", corner.x(), corner.y());
      }
      const auto byte = [&](std::size_t k) { return static_cast<int>(std::lround(light * colour[k])); };
      add("\" fill=\"#{:02x}{:02x}{:02x}\"/>\n", byte(0), byte(1), byte(2));
    }
  }

  void legend(double top) {
    constexpr int kSteps = 40;
    constexpr double kBar = 240.0;  // px
    for (int k = 0; k < kSteps; ++k) {
      const double part = (k + 0.5) / kSteps;
      const Rgb colour = colour_of(picture_, picture_.has_sign ? (2.0 * part - 1.0) * top_ : part * top_, top_);
      const auto byte = [&](std::size_t c) { return static_cast<int>(std::lround(colour[c])); };
      add("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"12\" fill=\"#{:02x}{:02x}{:02x}\"/>\n",
          kMargin + k * kBar / kSteps, top, kBar / kSteps + 0.3, byte(0), byte(1), byte(2));
    }
    text(kMargin, top + 28.0, "faint", picture_.has_sign ? fmt::format("\u2212{:.4g}", top_) : "0");
    text(kMargin + kBar, top + 28.0, "faint end", fmt::format("{:.4g}", top_));
    text(kMargin + kBar + 14.0, top + 10.0, "name", fmt::format("{} / {}", picture_.field, picture_.unit));
  }

  const ShapePicture& picture_;
  double top_;
  double scale_ = 1.0;  // px per m
  std::vector<Vec3> reference_;
  Frame frame_;
};

}  // namespace

ShapeSurface surface_of(const mesh::TetMesh& mesh) {
  ShapeSurface out;
  std::vector<std::int32_t> number(mesh.node_count(), -1);
  for (const mesh::TetFace face : mesh::find_faces(mesh).boundary) {
    std::array<std::int32_t, 3> corners{};
    const std::array<NodeId, 3> nodes = mesh::face_nodes(mesh, face);
    for (std::size_t k = 0; k < 3; ++k) {
      std::int32_t& own = number[nodes[k].index()];
      if (own < 0) {
        own = static_cast<std::int32_t>(out.nodes.size());
        out.nodes.push_back(mesh.node(nodes[k]));
        out.node.push_back(nodes[k]);
      }
      corners[k] = own;
    }
    out.faces.push_back(corners);
    out.tet.push_back(face.tet);
  }
  return out;
}

double top_of(const ShapePicture& picture) {
  std::vector<double> sizes;
  for (const ShapePanel& panel : picture.panels)
    for (const double value : panel.values) sizes.push_back(picture.has_sign ? std::abs(value) : value);
  if (sizes.empty()) return 0.0;
  const auto typical = sizes.begin() + static_cast<std::ptrdiff_t>(kShare * static_cast<double>(sizes.size() - 1));
  std::nth_element(sizes.begin(), typical, sizes.end());
  if (!(*typical > 0.0) || !std::isfinite(*typical)) return 0.0;
  const double power = std::pow(10.0, std::floor(std::log10(*typical)));
  for (const double step : {1.0, 1.5, 2.0, 3.0, 5.0, 7.0})
    if (step * power >= *typical) return step * power;
  return 10.0 * power;
}

std::string shape_svg(const ShapePicture& picture) {
  RHEXIS_CHECK(!picture.panels.empty() && !picture.surface.faces.empty(), "picture '{}' of nothing", picture.title);
  for (const ShapePanel& panel : picture.panels)
    RHEXIS_CHECK(panel.displacement.size() == picture.surface.nodes.size() &&
                     (panel.values.empty() || panel.values.size() == picture.surface.faces.size()),
                 "panel '{}': {} displacements, {} values", panel.title, panel.displacement.size(),
                 panel.values.size());
  return Picture(picture).draw();
}

}  // namespace rhexis::result
