#include "agricolmap/io/cloud/cloud_stream.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/io/cloud/cloud_reader.hpp"
#include "agricolmap/io/cloud/point_spill.hpp"
#include "agricolmap/io/cloud/point_taking.hpp"

namespace agricolmap::io {
namespace {

/// Points of a piece of what was spilled: few enough for all threads to have some of a batch.
constexpr std::size_t kPiece = std::size_t{1} << 15;
/// Chunks between two looks at the clock and at the file. Those of LAZ are large: threads wait for
/// the last of a group.
constexpr std::size_t kCheapGroup = 64;
constexpr std::size_t kDearGroup = 256;

class KeptCloud : public PointStream {
 public:
  explicit KeptCloud(Cloud cloud) : cloud_(std::move(cloud)), stream_(cloud_) {}
  const CloudFacts& facts() const override { return stream_.facts(); }
  Box3 box() const override { return stream_.box(); }
  void pass(const Visit& visit) const override { stream_.pass(visit); }

 private:
  Cloud cloud_;
  CloudStream stream_;
};

void extend(const TakenPoints& taken, Box3& box) {
  for (std::size_t i = 0; i < taken.count; ++i) {
    box.min = box.min.cwiseMin(taken.xyz[i]);
    box.max = box.max.cwiseMax(taken.xyz[i]);
  }
}

/// What a chunk's first pass leaves.
struct ChunkFacts {
  Tally tally;
  Box3 box;
};

/// Gathers a chunk's points until they are worth a call of the system.
class SpillWriter {
 public:
  SpillWriter(PointSpill& spill, std::size_t first, PointSpill::Kind kind)
      : spill_(spill), first_(first), kind_(kind) {}
  void add(const TakenPoints& taken) {
    const auto append = [&](auto& to, const auto& from) {
      to.insert(to.end(), from.begin(), from.begin() + taken.count);
    };
    append(xyz_, taken.xyz);
    if (kind_.coloured) append(rgb_, taken.rgb);
    if (kind_.marked) append(marks_, taken.marks);
    if (xyz_.size() >= kPiece) flush();
  }
  void flush() {
    spill_.write(first_, xyz_, rgb_, marks_);
    first_ += xyz_.size();
    xyz_.clear();
    rgb_.clear();
    marks_.clear();
  }

 private:
  PointSpill& spill_;
  std::size_t first_;
  PointSpill::Kind kind_;
  std::vector<Eigen::Vector3f> xyz_;
  std::vector<Rgb> rgb_;
  std::vector<PointMarks> marks_;
};

/// What becomes of decoded points that are dear.
enum class Dear { kSpilled, kForgotten };

class FileStream : public MarkedStream {
 public:
  FileStream(std::unique_ptr<MappedFile> mapped, PointFile file, const StreamOptions& options,
             Dear dear)
      : mapped_(std::move(mapped)),
        file_(std::move(file)),
        on_pass_(options.on_pass),
        spills_(dear == Dear::kSpilled && file_.source->dear()) {
    const FirstLook first = firstLook(*file_.source);
    taking_ = first.taking;
    std::vector<ChunkFacts> chunks = lookAtAll();
    taking_ = finalTaking(file_, first, total(chunks));
    if (!(taking_ == first.taking)) chunks = lookAtAll();
    cutIntoPieces(chunks);
    setFacts(chunks, options.crs);
  }

  const CloudFacts& facts() const override { return facts_; }
  Box3 box() const override { return box_; }
  void pass(const Visit& visit) const override {
    passAll(false, [&](const PointBatch& batch, std::span<const PointMarks>) { visit(batch); });
  }
  void passMarked(const MarkedVisit& visit) const override {
    passAll(file_.source->marked(), visit);
  }

 private:
  /// Points that are loaded together.
  struct Piece {
    std::size_t begin = 0;  ///< in the cloud
    std::size_t count = 0;
    std::size_t place = 0;  ///< chunk of the source, or point of the spill
  };
  /// Part of the cloud that is in memory.
  struct Loaded {
    bool coloured = false;
    bool marked = false;
    std::vector<Eigen::Vector3f> xyz;
    std::vector<Rgb> rgb;
    std::vector<PointMarks> marks;
    std::size_t first = 0;  ///< its first point in the cloud
    std::size_t count = 0;

    void makeRoom(std::size_t points);
    PointBatch batch(std::size_t points) const;
    std::span<const PointMarks> marksOf(std::size_t points) const {
      return std::span(marks).first(marked ? points : 0);
    }
    void dropFirst(std::size_t points);
  };

  static Tally total(const std::vector<ChunkFacts>& chunks) {
    Tally sum;
    for (const ChunkFacts& chunk : chunks) sum += chunk.tally;
    return sum;
  }
  /// Of what is spilled: before all colours were seen nobody knows whether they are any.
  PointSpill::Kind kind() const {
    return {file_.source->colourKind() != ColourKind::kNone, file_.source->marked()};
  }
  void tell(std::size_t seen) const {
    if (on_pass_) on_pass_(seen, file_.source->points());
  }

  std::vector<ChunkFacts> lookAtAll();
  ChunkFacts lookAt(std::size_t chunk) const;
  void cutIntoPieces(const std::vector<ChunkFacts>& chunks);
  void setFacts(const std::vector<ChunkFacts>& chunks, const Crs& crs);
  std::size_t load(std::size_t begin, Loaded& loaded) const;
  void loadPiece(const Piece& piece, Loaded& loaded) const;
  void passAll(bool marked, const MarkedVisit& visit) const;

  std::unique_ptr<MappedFile> mapped_;
  PointFile file_;
  std::function<void(std::size_t, std::size_t)> on_pass_;
  bool spills_;
  Taking taking_;
  std::unique_ptr<PointSpill> spill_;  ///< where decoding is dear
  std::vector<Piece> pieces_;
  CloudFacts facts_;
  Box3 box_;
};

/// The first pass.
std::vector<ChunkFacts> FileStream::lookAtAll() {
  const PointSource& source = *file_.source;
  if (spills_) {
    spill_.reset();  // there need not be room for both
    spill_ = std::make_unique<PointSpill>(source.points(), kind(), file_.name);
  }
  std::vector<ChunkFacts> chunks(source.chunks());
  const std::size_t group = source.dear() ? kDearGroup : kCheapGroup;
  for (std::size_t begin = 0; begin < chunks.size(); begin += group) {
    const std::size_t end = std::min(chunks.size(), begin + group);
    parallelFor(end - begin, [&](std::size_t i) { chunks[begin + i] = lookAt(begin + i); });
    mapped_->release();
    tell(end < chunks.size() ? source.firstPoint(end) : source.points());
  }
  return chunks;
}

ChunkFacts FileStream::lookAt(std::size_t chunk) const {
  ChunkFacts facts;
  if (!spill_) {
    facts.tally = takeChunk(*file_.source, chunk, taking_,
                            [&](const TakenPoints& taken) { extend(taken, facts.box); });
    return facts;
  }
  SpillWriter writer(*spill_, file_.source->firstPoint(chunk), kind());
  facts.tally = takeChunk(*file_.source, chunk, taking_, [&](const TakenPoints& taken) {
    extend(taken, facts.box);
    writer.add(taken);
  });
  writer.flush();
  return facts;
}

void FileStream::cutIntoPieces(const std::vector<ChunkFacts>& chunks) {
  std::size_t next = 0;
  for (std::size_t chunk = 0; chunk < chunks.size(); ++chunk) {
    const std::size_t kept = chunks[chunk].tally.kept;
    const std::size_t most = spill_ ? kPiece : std::max<std::size_t>(kept, 1);
    for (std::size_t done = 0; done < kept; done += most) {
      const std::size_t count = std::min(most, kept - done);
      pieces_.push_back(
          {next + done, count, spill_ ? file_.source->firstPoint(chunk) + done : chunk});
    }
    next += kept;
  }
}

void FileStream::setFacts(const std::vector<ChunkFacts>& chunks, const Crs& crs) {
  const Tally sum = total(chunks);
  for (const ChunkFacts& chunk : chunks) {
    box_.min = box_.min.cwiseMin(chunk.box.min);
    box_.max = box_.max.cwiseMax(chunk.box.max);
  }
  facts_.name = file_.name;
  facts_.origin = taking_.origin;
  facts_.points = sum.kept;
  facts_.coloured = isColoured(file_, sum);
  facts_.dropped_points = file_.source->points() - sum.kept;
  facts_.warnings = warningsOf(file_, taking_, sum);
  facts_.crs = crs;
  facts_.fields = file_.fields;
}

void FileStream::Loaded::makeRoom(std::size_t points) {
  const auto enlarge = [&](auto& values) {
    if (values.size() < points) values.resize(points);
  };
  enlarge(xyz);
  if (coloured) enlarge(rgb);
  if (marked) enlarge(marks);
}

PointBatch FileStream::Loaded::batch(std::size_t points) const {
  PointBatch batch{std::span(xyz).first(points), {}, first};
  if (coloured) batch.rgb = std::span(rgb).first(points);
  return batch;
}

void FileStream::Loaded::dropFirst(std::size_t points) {
  const std::size_t rest = count - points;
  const auto drop = [&](auto& values) {
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(points), rest, values.begin());
  };
  drop(xyz);
  if (coloured) drop(rgb);
  if (marked) drop(marks);
  first += points;
  count = rest;
}

void FileStream::loadPiece(const Piece& piece, Loaded& loaded) const {
  const std::size_t at = piece.begin - loaded.first;
  const auto part = [&](auto& values, bool wanted) {
    return std::span(values).subspan(wanted ? at : 0, wanted ? piece.count : 0);
  };
  const auto xyz = part(loaded.xyz, true);
  const auto rgb = part(loaded.rgb, loaded.coloured);
  const auto marks = part(loaded.marks, loaded.marked);
  if (spill_) {
    spill_->read(piece.place, xyz, rgb, marks);
    return;
  }
  std::size_t done = 0;
  takeChunk(*file_.source, piece.place, taking_, [&](const TakenPoints& taken) {
    const std::size_t count = std::min(taken.count, piece.count - done);
    const auto to = static_cast<std::ptrdiff_t>(done);
    std::copy_n(taken.xyz.begin(), count, xyz.begin() + to);
    if (loaded.coloured) std::copy_n(taken.rgb.begin(), count, rgb.begin() + to);
    if (loaded.marked) std::copy_n(taken.marks.begin(), count, marks.begin() + to);
    done += count;
  });
  if (done == piece.count) return;
  throw InputError(fmt::format("{}: was changed while it was read", file_.name));
}

/// Loads pieces from `begin` on until there is a batch; returns the next piece.
std::size_t FileStream::load(std::size_t begin, Loaded& loaded) const {
  std::size_t end = begin;
  std::size_t count = loaded.count;
  while (end < pieces_.size() && count < kBatch) count += pieces_[end++].count;
  loaded.makeRoom(count);
  parallelFor(end - begin, [&](std::size_t i) { loadPiece(pieces_[begin + i], loaded); });
  if (!spill_) mapped_->release();
  loaded.count = count;
  return end;
}

void FileStream::passAll(bool marked, const MarkedVisit& visit) const {
  Loaded loaded;
  loaded.coloured = facts_.coloured;
  loaded.marked = marked;
  // Asked before anything is looked at: of a file that was cut off meanwhile nothing is there.
  if (!spill_) mapped_->release();
  for (std::size_t next = 0; next < pieces_.size() || loaded.count > 0;) {
    next = load(next, loaded);
    const std::size_t count = std::min(kBatch, loaded.count);
    visit(loaded.batch(count), loaded.marksOf(count));
    loaded.dropFirst(count);
    tell(loaded.first == facts_.points ? file_.source->points() : loaded.first);
  }
}

}  // namespace

std::unique_ptr<PointStream> streamCloud(const std::filesystem::path& path,
                                         const StreamOptions& options) {
  auto mapped = std::make_unique<MappedFile>(path);
  const std::string name = options.shown.empty() ? path.string() : options.shown;
  PointFile file = openPoints(*mapped, name, options.read);
  if (file.source->points() > options.keep || file.source->marked()) {
    return std::make_unique<FileStream>(std::move(mapped), std::move(file), options,
                                        Dear::kSpilled);
  }
  Cloud cloud = assembleCloud(file);
  cloud.crs = options.crs;
  return keptStream(std::move(cloud));
}

CloudFacts factsOfFile(const std::filesystem::path& path, const StreamOptions& options) {
  auto mapped = std::make_unique<MappedFile>(path);
  PointFile file = openPoints(*mapped, path.string(), options.read);
  return FileStream(std::move(mapped), std::move(file), options, Dear::kForgotten).facts();
}

std::unique_ptr<PointStream> keptStream(Cloud cloud) {
  return std::make_unique<KeptCloud>(std::move(cloud));
}

}  // namespace agricolmap::io
