// The common coordinate system of two clouds, and what brings them into it.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <mutex>
#include <numbers>
#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/crs/crs.hpp"
#include "agricolmap/io/crs/srs.hpp"

namespace agricolmap::io {
namespace {

/// Where every metre is one, to this.
constexpr double kGroundTolerance = 0.01;
constexpr double kUnitTolerance = 1e-12;

OGRSpatialReference srsOf(const Crs& crs) {
  auto srs = srsFrom(crs.wkt);
  if (!srs)
    throw InputError(fmt::format("the coordinate system {} cannot be understood", crs.name));
  return *std::move(srs);
}

/// Other units alone.
class UnitMap : public CoordinateMap {
 public:
  UnitMap(double horizontal, double vertical) : horizontal_(horizontal), vertical_(vertical) {}
  void apply(double* x, double* y, double* z, std::size_t count) const override {
    for (std::size_t i = 0; i < count; ++i) {
      x[i] *= horizontal_;
      y[i] *= horizontal_;
      z[i] *= vertical_;
    }
  }

 private:
  double horizontal_;
  double vertical_;
};

/// Another projection, and heights in metres.
class ProjectedMap : public CoordinateMap {
 public:
  ProjectedMap(const OGRSpatialReference& from, const OGRSpatialReference& to, double vertical)
      : vertical_(vertical) {
    const QuietGdal quiet;
    first_.reset(OGRCreateCoordinateTransformation(&from, &to));
    if (!first_) {
      throw InputError(fmt::format("there is no way from {} to {}", from.GetName(), to.GetName()));
    }
  }
  void apply(double* x, double* y, double* z, std::size_t count) const override {
    const QuietGdal quiet;
    std::unique_ptr<OGRCoordinateTransformation> transformation = take();
    std::vector<int> done(count);
    // Heights stay as they are: a datum would need grids, and a registration finds the difference.
    transformation->Transform(static_cast<int>(count), x, y, nullptr, done.data());
    give(std::move(transformation));
    for (std::size_t i = 0; i < count; ++i) {
      z[i] *= vertical_;
      if (done[i] == 0) x[i] = std::numeric_limits<double>::infinity();
    }
  }

 private:
  /// PROJ's transformations belong to one thread at a time.
  std::unique_ptr<OGRCoordinateTransformation> take() const {
    const std::lock_guard lock(mutex_);
    if (spare_.empty()) return std::unique_ptr<OGRCoordinateTransformation>(first_->Clone());
    auto transformation = std::move(spare_.back());
    spare_.pop_back();
    return transformation;
  }
  void give(std::unique_ptr<OGRCoordinateTransformation> transformation) const {
    const std::lock_guard lock(mutex_);
    spare_.push_back(std::move(transformation));
  }
  double vertical_;
  std::unique_ptr<OGRCoordinateTransformation> first_;
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<OGRCoordinateTransformation>> spare_;
};

bool isMetre(double unit) { return std::abs(unit - 1.0) < kUnitTolerance; }

/// The same system with all axes in metres.
Crs inMetres(const Crs& crs) {
  if (isMetre(crs.horizontal_unit) && isMetre(crs.vertical_unit)) return crs;
  const QuietGdal quiet;
  const OGRSpatialReference srs = srsOf(crs);
  OGRSpatialReference horizontal = horizontalOf(srs);
  if (!isMetre(crs.horizontal_unit)) {
    horizontal.SetLinearUnitsAndUpdateParameters("metre", 1.0, "EPSG", "9001");
    horizontal.SetProjCS(fmt::format("{} in metres", horizontal.GetName()).c_str());
  }
  OGRSpatialReference metric = horizontal;
  if (srs.IsCompound() != 0) {
    const char* const name = srs.GetAttrValue("VERT_CS");
    const char* const datum = srs.GetAttrValue("VERT_DATUM");
    OGRSpatialReference vertical;
    vertical.SetVertCS(name == nullptr ? "height" : name, datum == nullptr ? "unknown" : datum);
    const std::string compound = fmt::format("{} + {}", horizontal.GetName(), vertical.GetName());
    OGRSpatialReference both;
    if (both.SetCompoundCS(compound.c_str(), &horizontal, &vertical) == OGRERR_NONE) metric = both;
  }
  Crs result = crsFrom(metric);
  result.horizontal_unit = 1.0;
  result.vertical_unit = 1.0;
  return result;
}

bool isSame(const OGRSpatialReference& one, const OGRSpatialReference& other) {
  const char* const lenient[] = {"IGNORE_DATA_AXIS_TO_SRS_AXIS_MAPPING=YES", "CRITERION=EQUIVALENT",
                                 nullptr};
  return one.IsSame(&other, lenient) != 0;
}

/// From `from` into `to`, which is in metres; nothing when coordinates stay as they are.
std::unique_ptr<CoordinateMap> mapBetween(const Crs& from, const Crs& to, bool& reprojected) {
  const QuietGdal quiet;
  const OGRSpatialReference source = horizontalOf(srsOf(from));
  reprojected = !isSame(source, horizontalOf(srsOf(to))) &&
                !isSame(horizontalOf(srsOf(inMetres(from))), horizontalOf(srsOf(to)));
  if (reprojected) {
    return std::make_unique<ProjectedMap>(source, horizontalOf(srsOf(to)), from.vertical_unit);
  }
  if (isMetre(from.horizontal_unit) && isMetre(from.vertical_unit)) return nullptr;
  return std::make_unique<UnitMap>(from.horizontal_unit, from.vertical_unit);
}

void warnOfUnits(const FileCrs& file, std::vector<std::string>& warnings) {
  if (!file.crs || (isMetre(file.crs->horizontal_unit) && isMetre(file.crs->vertical_unit))) return;
  warnings.push_back(fmt::format(
      "{}: its coordinates are in units of {} m, its heights in units of {} m ({}); brought to "
      "metres",
      file.name, file.crs->horizontal_unit, file.crs->vertical_unit, file.crs->name));
}

void append(std::vector<std::string>& to, const std::vector<std::string>& from) {
  for (const std::string& text : from) to.push_back(text);
}

/// The one of which nothing is known is taken to be where the other is.
FileCrs assumed(const FileCrs& file, const FileCrs& other, std::vector<std::string>& warnings) {
  FileCrs result = file;
  if (file.crs || !other.crs) return result;
  result.crs = other.crs;
  warnings.push_back(
      fmt::format("{}: it does not say its coordinate system; taken as that of {} ({})", file.name,
                  other.name, other.crs->name));
  return result;
}

}  // namespace

bool isProjected(const Crs& crs) {
  if (crs.wkt.empty()) return true;
  const QuietGdal quiet;
  const OGRSpatialReference srs = srsOf(crs);
  return srs.IsGeographic() == 0 && srs.IsGeocentric() == 0;
}

CommonFrame commonFrame(const FileCrs& fixed_file, const FileCrs& moving_file) {
  CommonFrame frame;
  append(frame.warnings, fixed_file.warnings);
  append(frame.warnings, moving_file.warnings);
  const FileCrs fixed = assumed(fixed_file, moving_file, frame.warnings);
  const FileCrs moving = assumed(moving_file, fixed_file, frame.warnings);
  frame.fixed_file = fixed.crs;
  frame.moving_file = moving.crs;
  if (!fixed.crs || !moving.crs) return frame;
  const bool by_fixed = isProjected(*fixed.crs);
  if (!by_fixed && !isProjected(*moving.crs)) {
    throw InputError(fmt::format(
        "{} and {}: their coordinates are degrees ({}), not metres; bring one into a projected "
        "coordinate system first: EPSG:326<zone> (UTM north; 327<zone> south)",
        fixed.name, moving.name, fixed.crs->name));
  }
  frame.crs = inMetres(by_fixed ? *fixed.crs : *moving.crs);
  warnOfUnits(fixed, frame.warnings);
  warnOfUnits(moving, frame.warnings);
  bool fixed_reprojected = false;
  frame.fixed = mapBetween(*fixed.crs, frame.crs, fixed_reprojected);
  frame.moving = mapBetween(*moving.crs, frame.crs, frame.moving_reprojected);
  for (const FileCrs* file : {&fixed, &moving}) {
    if (file == &fixed ? !fixed_reprojected : !frame.moving_reprojected) continue;
    frame.warnings.push_back(
        fmt::format("{}: reprojected from {} to {}", file->name, file->crs->name, frame.crs.name));
  }
  return frame;
}

CommonFrame frameIn(const FileCrs& cloud, const std::string& target) {
  FileCrs to = crsOf(cloud.name, target);
  if (!isProjected(*to.crs)) {
    throw UsageError(
        fmt::format("{} ({}) is not a projected coordinate system", target, to.crs->name));
  }
  if (!cloud.crs) {
    throw InputError(
        fmt::format("{}: it does not say its coordinate system, so it cannot be brought into {}",
                    cloud.name, to.crs->name));
  }
  to.name = target;
  to.crs = inMetres(*to.crs);
  return commonFrame(to, cloud);
}

void checkGroundScale(const std::string& name, const Crs& crs, const Eigen::Vector2d& at) {
  if (crs.wkt.empty() || !isProjected(crs)) return;
  const QuietGdal quiet;
  const OGRSpatialReference srs = horizontalOf(srsOf(crs));
  if (srs.IsProjected() == 0) return;
  const std::unique_ptr<OGRSpatialReference> degrees(srs.CloneGeogCS());
  if (!degrees) return;
  degrees->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::unique_ptr<OGRCoordinateTransformation> transformation(
      OGRCreateCoordinateTransformation(&srs, degrees.get()));
  constexpr double kStep = 100.0;
  const double step = kStep / crs.horizontal_unit;
  double lon[] = {at.x(), at.x() + step, at.x()};
  double lat[] = {at.y(), at.y(), at.y() + step};
  if (!transformation || transformation->Transform(3, lon, lat) == FALSE) return;
  const double radians = std::numbers::pi / 180.0;
  const double a = degrees->GetSemiMajor();
  const double flat = degrees->GetInvFlattening();
  const double e2 = flat > 0.0 ? (2.0 - 1.0 / flat) / flat : 0.0;
  const double w = 1.0 - e2 * std::pow(std::sin(lat[0] * radians), 2);
  const double along_meridian = a * (1.0 - e2) / std::pow(w, 1.5) * radians;
  const double along_parallel = a / std::sqrt(w) * std::cos(lat[0] * radians) * radians;
  for (const int i : {1, 2}) {
    const double ground =
        std::hypot(along_parallel * (lon[i] - lon[0]), along_meridian * (lat[i] - lat[0]));
    const double factor = ground / kStep;
    if (std::abs(factor - 1.0) <= kGroundTolerance) continue;
    throw InputError(fmt::format(
        "{}: a metre of its coordinate system ({}) is {:.4f} m on the ground at ({:.0f}, "
        "{:.0f}); bring it into one that keeps lengths: EPSG:326<zone> (UTM north; "
        "327<zone> south)",
        name, crs.name, factor, at.x(), at.y()));
  }
}

}  // namespace agricolmap::io
