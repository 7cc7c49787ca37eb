#include "agricolmap/io/las/las_feed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/cloud/block_move.hpp"
#include "agricolmap/io/cloud/point_source.hpp"
#include "agricolmap/io/las/las_lift.hpp"

namespace agricolmap::io {
namespace {

constexpr std::size_t kBlock = 512;

/// Steps that are fit for metres, or one that is.
Eigen::Vector3d fitSteps(const Eigen::Vector3d& steps, const CloudMove& move) {
  constexpr double kFinest = 1e-5;
  constexpr double kCoarsest = 0.01;
  constexpr double kMillimetre = 0.001;
  if (move.map != nullptr) return Eigen::Vector3d::Constant(kMillimetre);
  return steps.unaryExpr([&](double step) {
    const double size = std::abs(step);
    return size >= kFinest && size <= kCoarsest ? size : kMillimetre;
  });
}

/// Whether the extra bytes of points are called as normals are.
bool hasNormals(const LasHeader& header) {
  constexpr std::uint16_t kExtraBytes = 4;
  constexpr std::size_t kEntry = 192;
  constexpr std::size_t kName = 4;
  const LasRecord* const record = header.find("LASF_Spec", kExtraBytes);
  for (std::size_t at = 0; record != nullptr && at + kEntry <= record->data.size(); at += kEntry) {
    std::string name(reinterpret_cast<const char*>(&record->data[at + kName]), 32);
    name.resize(std::min(name.find('\0'), name.size()));
    for (char& c : name) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 'a' - 'A') : c;
    if (name.find("normal") != std::string::npos || name == "nx") return true;
  }
  return false;
}

class FileFeed : public LasFeed {
 public:
  FileFeed(const std::filesystem::path& file, const std::optional<CloudMove>& move, const Crs& crs,
           bool extended)
      : file_(file),
        header_(parseLasHeader(file_.bytes(), file.string())),
        source_(lasPoints(file_.bytes(), header_, file.string())),
        move_(move) {
    outline_ = lasOutline(file_.bytes(), header_);
    if (move_) {
      outline_.scale = fitSteps(outline_.scale, *move_);
      outline_.offset = move_->target_from_file(move_->origin).array().round().matrix();
    }
    if (!crs.wkt.empty()) outline_.setCrs(crs.wkt);
    if (move_ && hasNormals(header_)) {
      warnings.push_back(fmt::format(
          "{}: its extra bytes have normals, which are kept as they stand and not turned",
          file.string()));
    }
    if (header_.layout.wave) {
      warnings.push_back(fmt::format(
          "{}: its points refer to wave packets, which are not taken along", file.string()));
    }
    lifted_ = extended && (!header_.layout.extended || header_.layout.wave);
    if (lifted_) outline_ = lifted(std::move(outline_));
  }

  std::uint64_t points() const override { return header_.points; }
  void pass(const Visit& visit) const override {
    visit(source_->chunks(),
          [this](std::size_t chunk, std::vector<std::byte>& records) { load(chunk, records); });
  }
  void forget() const override { file_.release(); }

 private:
  using Block = std::array<std::array<double, kBlock>, 3>;

  void load(std::size_t chunk, std::vector<std::byte>& records) const {
    const std::size_t length = header_.layout.length;
    records.clear();
    source_->decode(chunk, LasWanted::kAll, [&](const std::byte* first, std::size_t count) {
      records.insert(records.end(), first, first + count * length);
    });
    if (move_) records.resize(moveRecords(records) * length);
    if (lifted_) records = lifted(records, header_.layout, outline_.layout);
  }

  /// Moves records in place and closes the gaps of those that have no place; how many are left.
  std::size_t moveRecords(std::vector<std::byte>& records) const {
    const std::size_t length = header_.layout.length;
    const std::size_t count = records.size() / length;
    Block xyz;
    std::array<bool, kBlock> fits{};
    std::size_t kept = 0;
    for (std::size_t begin = 0; begin < count; begin += kBlock) {
      const std::size_t block = std::min(kBlock, count - begin);
      for (std::size_t i = 0; i < block; ++i) {
        const Eigen::Vector3d point = header_.pointOf(&records[(begin + i) * length]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
          xyz[axis][i] = point[static_cast<Eigen::Index>(axis)];
        }
      }
      moveBlock(xyz, block, fits);
      for (std::size_t i = 0; i < block; ++i) {
        if (!fits[i]) continue;
        const std::byte* const from = &records[(begin + i) * length];
        std::byte* const to = &records[kept * length];
        if (to != from) std::copy_n(from, length, to);
        for (std::size_t axis = 0; axis < 3; ++axis) {
          storeLe(to + 4 * axis, static_cast<std::int32_t>(xyz[axis][i]));
        }
        ++kept;
      }
    }
    return kept;
  }

  /// From coordinates to steps of the target, and whether they are any.
  void moveBlock(Block& xyz, std::size_t count, std::array<bool, kBlock>& fits) const {
    constexpr double kMost = std::numeric_limits<std::int32_t>::max();
    double* const x = xyz[0].data();
    double* const y = xyz[1].data();
    double* const z = xyz[2].data();
    if (move_->map != nullptr) move_->map->apply(x, y, z, count);
    const Eigen::Vector3d origin = move_->origin;
    for (std::size_t i = 0; i < count; ++i) {
      fits[i] = std::abs(x[i] - origin.x()) <= kMaxFromOrigin &&
                std::abs(y[i] - origin.y()) <= kMaxFromOrigin &&
                std::abs(z[i] - origin.z()) <= kMaxFromOrigin;
    }
    moveAll(move_->target_from_file, x, y, z, count);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double offset = outline_.offset[static_cast<Eigen::Index>(axis)];
      const double scale = outline_.scale[static_cast<Eigen::Index>(axis)];
      std::array<double, kBlock>& steps = xyz[axis];
      for (std::size_t i = 0; i < count; ++i) steps[i] = std::rint((steps[i] - offset) / scale);
      for (std::size_t i = 0; i < count; ++i) fits[i] = fits[i] && std::abs(steps[i]) <= kMost;
    }
  }

  MappedFile file_;
  LasHeader header_;
  std::unique_ptr<LasPoints> source_;
  std::optional<CloudMove> move_;
  bool lifted_ = false;
};

class StreamFeed : public LasFeed {
 public:
  StreamFeed(const PointStream& points, PointMove target_from_file, std::string name)
      : points_(points), target_from_file_(std::move(target_from_file)), name_(std::move(name)) {
    const CloudFacts& facts = points.facts();
    outline_ = lasOutline(facts.coloured);
    outline_.offset = target_from_file_(facts.origin).array().round().matrix();
    if (!facts.crs.wkt.empty()) outline_.setCrs(facts.crs.wkt);
  }

  std::uint64_t points() const override { return points_.facts().points; }

  void pass(const Visit& visit) const override {
    points_.pass([&](const PointBatch& batch) {
      visit((batch.size() + kPoints - 1) / kPoints,
            [&](std::size_t chunk, std::vector<std::byte>& records) {
              load(batch, chunk * kPoints, records);
            });
    });
  }

 private:
  static constexpr std::size_t kPoints = std::size_t{1} << 14;
  static_assert(PointStream::kBatch % kPoints == 0, "batches have whole chunks");

  void load(const PointBatch& batch, std::size_t begin, std::vector<std::byte>& records) const {
    const std::size_t count = std::min(kPoints, batch.size() - begin);
    const std::size_t length = outline_.layout.length;
    records.assign(count * length, std::byte{0});
    for (std::size_t i = 0; i < count; ++i) store(batch, begin + i, &records[i * length]);
  }

  void store(const PointBatch& batch, std::size_t i, std::byte* record) const {
    const Eigen::Vector3d file_point = points_.facts().origin + batch.xyz[i].cast<double>();
    if (!outline_.store(target_from_file_(file_point), record)) {
      throw UsageError(name_ + ": its points are more than 2000 km apart, too far for LAS");
    }
    storeLe(record + 14, std::uint8_t{0x11});  // the first of one return
    if (batch.rgb.empty()) return;
    const Rgb colour = batch.rgb[i];
    constexpr std::uint16_t kWide = 257;
    storeLe(record + *outline_.layout.rgb, static_cast<std::uint16_t>(kWide * colour.r));
    storeLe(record + *outline_.layout.rgb + 2, static_cast<std::uint16_t>(kWide * colour.g));
    storeLe(record + *outline_.layout.rgb + 4, static_cast<std::uint16_t>(kWide * colour.b));
  }

  const PointStream& points_;
  PointMove target_from_file_;
  std::string name_;
};

}  // namespace

std::unique_ptr<LasFeed> feedOf(const std::filesystem::path& file,
                                const std::optional<CloudMove>& move, const Crs& crs,
                                bool extended) {
  return std::make_unique<FileFeed>(file, move, crs, extended);
}

std::unique_ptr<LasFeed> feedOf(const PointStream& points, const PointMove& target_from_file,
                                std::string name) {
  return std::make_unique<StreamFeed>(points, target_from_file, std::move(name));
}

}  // namespace agricolmap::io
