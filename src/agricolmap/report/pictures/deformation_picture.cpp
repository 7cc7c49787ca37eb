// deformation.png: how far the strip is displaced beside the best affine along its path, with what
// that is good to.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "agricolmap/core/round_step.hpp"
#include "agricolmap/report/draw/page.hpp"
#include "agricolmap/report/pictures/picture_kinds.hpp"

namespace agricolmap::report {
namespace {

constexpr int kPanelHeight = 170;
constexpr int kPanelGap = 34;
constexpr int kAxisRoom = 46;
constexpr int kPlaces = 400;
constexpr double kDeviations = 2.0;   // of the band
constexpr double kLeastReach = 0.01;  // of a panel's axis [m]
constexpr Colour kLine = hexColour(0x1f5fbf);
constexpr Colour kBand = hexColour(0x1f5fbf, 0.18);
constexpr Colour kSlip = hexColour(0xc62828);
constexpr Colour kGrid = hexColour(0xd5d9df);

/// A place of the path: displacement along, to the left and up, and their deviations [m].
struct Sample {
  double along;
  std::array<double, 3> value;
  std::array<double, 3> deviation;  ///< infinite where clouds without heights do not tell
};

/// What says that the strip is bent.
std::string witnessesOf(const deform::Bend& bend) {
  // Pieces of a long strip are chained; no fit leaves blocks out.
  if (bend.gain == 0.0 && bend.evidence == 0.0) return "as pieces of the path were found";
  return fmt::format("left-out blocks confirm it by {:.1f} standard errors", bend.gain);
}

std::vector<Sample> samplesOf(const pipeline::Placed& placed) {
  const deform::Deformation& deformation = placed.followed->bend.deformation;
  const double length = deformation.path().length();
  std::vector<Sample> samples;
  for (int i = 0; i <= kPlaces; ++i) {
    const double along = length * i / kPlaces;
    const Eigen::Vector2d ahead = deformation.tangent(along);
    const Eigen::Vector2d left(-ahead.y(), ahead.x());
    const Eigen::Vector3d d = deformation.onPath(along);
    const Eigen::Matrix2d covariance = verdict::placeCovariance(
        *placed.uncertainty, deformation.covarianceAt(deformation.path().point(along)));
    samples.push_back(
        {along,
         {ahead.dot(d.head<2>()), left.dot(d.head<2>()), d.z()},
         {std::sqrt(ahead.dot(covariance * ahead)), std::sqrt(left.dot(covariance * left)),
          std::hypot(placed.uncertainty->height_deviation, deformation.height_deviation)}});
  }
  return samples;
}

/// From path length and displacement to pixels.
struct Axes {
  PixelRect rect;
  double length;
  double reach;  ///< at the upper and, negative, at the lower edge [m]
  Eigen::Vector2d at(double along, double value) const {
    return {rect.x + rect.width * along / length,
            rect.y + 0.5 * rect.height * (1.0 - value / reach)};
  }
};

void drawGrid(PictureCanvas& canvas, const Axes& axes, bool lowest) {
  const double rise = roundStep(2.0 * axes.reach);
  for (int i = static_cast<int>(std::ceil(-axes.reach / rise)); i * rise <= axes.reach; ++i) {
    const double value = i * rise;
    const std::array<Eigen::Vector2d, 2> ends = {axes.at(0.0, value), axes.at(axes.length, value)};
    canvas.lines(ends, {i == 0 ? 1.5 : 1.0, i == 0 ? palette::kFaint : kGrid, {}});
    canvas.text(ends[0] + Eigen::Vector2d(-8.0, 4.0), fmt::format("{:g}", 100.0 * value),
                {12.0, palette::kFaint, false, Align::kRight});
  }
  const double step = roundStep(axes.length);
  for (double along = 0.0; along <= axes.length; along += step) {
    const std::array<Eigen::Vector2d, 2> ends = {axes.at(along, -axes.reach),
                                                 axes.at(along, axes.reach)};
    canvas.lines(ends, {1.0, kGrid, {}});
    if (lowest) {
      canvas.text(ends[0] + Eigen::Vector2d(0.0, 18.0), fmt::format("{:g}", along),
                  {12.0, palette::kFaint, false, Align::kCentre});
    }
  }
}

void drawCurve(PictureCanvas& canvas, const Axes& axes, const std::vector<Sample>& samples,
               std::size_t axis) {
  std::vector<Eigen::Vector2d> band, line;
  for (const Sample& sample : samples) {
    if (!std::isfinite(sample.deviation[axis])) continue;
    band.push_back(
        axes.at(sample.along, sample.value[axis] + kDeviations * sample.deviation[axis]));
  }
  for (auto sample = samples.rbegin(); sample != samples.rend(); ++sample) {
    if (!std::isfinite(sample->deviation[axis])) continue;
    band.push_back(
        axes.at(sample->along, sample->value[axis] - kDeviations * sample->deviation[axis]));
  }
  for (std::size_t i = 1; i < samples.size(); ++i) {
    line.push_back(axes.at(samples[i - 1].along, samples[i - 1].value[axis]));
    line.push_back(axes.at(samples[i].along, samples[i].value[axis]));
  }
  const PictureCanvas::Clip clip(canvas, axes.rect);
  if (!band.empty()) canvas.fillPolygon(band, kBand);
  canvas.lines(line, {2.5, kLine, {}});
}

}  // namespace

void writeDeformationPicture(const io::OutputPath& path, const Scene& scene) {
  const pipeline::Placed& placed = *scene.registration.placed;
  const deform::Bend& bend = placed.followed->bend;
  const std::vector<Sample> samples = samplesOf(placed);
  constexpr std::array<const char*, 3> kNames = {"along the path", "to its left", "up"};
  constexpr int kHeight = static_cast<int>(kNames.size()) * (kPanelHeight + kPanelGap);
  Page page(kHeight + kAxisRoom + kMargin,
            "Deformation: the strip beside the best affine, along its path",
            fmt::format("centimetres over metres of path; {:.1f} cm RMS in the plane; {}",
                        100.0 * bend.rms, witnessesOf(bend)),
            scene.registration.verdict, true);
  PictureCanvas& canvas = page.canvas;
  // One scale for all panels, so that they can be compared.
  double reach = kLeastReach;
  for (const Sample& sample : samples) {
    for (std::size_t axis = 0; axis < kNames.size(); ++axis) {
      const double band = std::isfinite(sample.deviation[axis]) ? sample.deviation[axis] : 0.0;
      reach = std::max(reach, 1.05 * (std::abs(sample.value[axis]) + kDeviations * band));
    }
  }
  for (std::size_t axis = 0; axis < kNames.size(); ++axis) {
    const int top = page.top + kPanelGap / 2 + static_cast<int>(axis) * (kPanelHeight + kPanelGap);
    const Axes axes{{kMargin + 40, top, kInnerWidth - 40, kPanelHeight},
                    bend.deformation.path().length(),
                    reach};
    drawGrid(canvas, axes, axis + 1 == kNames.size());
    for (const deform::Slip& slip : bend.deformation.slips) {
      const std::array<Eigen::Vector2d, 2> ends = {axes.at(slip.along, -reach),
                                                   axes.at(slip.along, reach)};
      canvas.lines(ends, {1.5, kSlip, {6.0, 4.0}});
    }
    drawCurve(canvas, axes, samples, axis);
    const bool known = std::isfinite(samples.front().deviation[axis]);
    canvas.text({static_cast<double>(axes.rect.x), top - 6.0},
                known ? kNames[axis] : "up: not known, a cloud has no heights",
                {13.0, palette::kInk, true, Align::kLeft});
  }
  std::vector<LegendItem> legend = {
      {LegendItem::Kind::kLine, kLine, "displacement", {}},
      {LegendItem::Kind::kSquare, kBand, "two deviations of where the strip then lies", {}}};
  if (!bend.deformation.slips.empty()) {
    legend.push_back({LegendItem::Kind::kLine, kSlip, "slip", {6.0, 4.0}});
  }
  drawLegend(canvas, {kMargin + 40.0, page.top + kHeight + 34.0}, legend, false);
  canvas.write(path);
}

}  // namespace agricolmap::report
