#include "agricolmap/io/raster/geo_writer.hpp"

#include <cpl_error.h>
#include <cpl_string.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <gdal_priv.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <mutex>
#include <system_error>
#include <type_traits>
#include <vector>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/io/crs/srs.hpp"

namespace agricolmap::io {
namespace {

template <typename T>
constexpr GDALDataType kTypeOf = std::is_same_v<T, float>           ? GDT_Float32
                                 : std::is_same_v<T, std::uint16_t> ? GDT_UInt16
                                 : std::is_same_v<T, std::int32_t>  ? GDT_Int32
                                                                    : GDT_Byte;

template <typename T>
void checkSize(const OutputPath& path, const Raster<T>& values, const GridFrame& frame) {
  if (values.rows() == frame.rows && values.cols() == frame.cols) return;
  throw UsageError(fmt::format("{}: values of {} x {} cells do not fit a grid of {} x {}",
                               path.shown(), values.cols(), values.rows(), frame.cols, frame.rows));
}

void checkLayer(const OutputPath& path, const GeoLayer& layer) {
  if (layer.bands.empty() || layer.frame.rows < 1 || layer.frame.cols < 1 ||
      !(layer.frame.cell > 0.0)) {
    throw UsageError(fmt::format("{}: a layer needs a band and a cell", path.shown()));
  }
  for (const GeoBand& band : layer.bands) {
    if (band.values.index() != layer.bands.front().values.index()) {
      throw UsageError(fmt::format("{}: its bands are of several types", path.shown()));
    }
    std::visit([&](const auto* values) { checkSize(path, *values, layer.frame); }, band.values);
  }
  if (layer.add != 0.0 && !std::holds_alternative<const Raster<float>*>(layer.bands[0].values)) {
    throw UsageError(fmt::format("{}: only floats can be shifted", path.shown()));
  }
  if (layer.mask != nullptr) checkSize(path, *layer.mask, layer.frame);
}

GDALDriver& driverOf(const char* name) {
  static std::once_flag registered;
  std::call_once(registered, [] { GDALAllRegister(); });
  GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName(name);
  if (driver == nullptr) {
    throw UsageError(fmt::format("GDAL was built without its driver {}, which layers need", name));
  }
  return *driver;
}

/// GDAL's view of a layer in memory, northernmost row first, without a copy of the values.
class LayerInMemory {
 public:
  LayerInMemory(const OutputPath& path, const GeoLayer& layer)
      : frame_(layer.frame),
        dataset_(driverOf("MEM").Create("", frame_.cols, frame_.rows, 0, GDT_Byte, nullptr)) {
    if (!dataset_) throw Error(ErrorKind::kInternal, "GDAL makes no dataset in memory");
    setPlace(path, layer);
    shifted_.reserve(layer.bands.size());
    for (const GeoBand& band : layer.bands) {
      std::visit([&](const auto* values) { addBand(*values, band, layer); }, band.values);
    }
    if (layer.mask != nullptr) setMask(*layer.mask);
    for (const auto& [key, value] : layer.metadata) {
      dataset_->SetMetadataItem(key.c_str(), value.c_str());
    }
  }

  GDALDataset& dataset() { return *dataset_; }

 private:
  void setPlace(const OutputPath& path, const GeoLayer& layer) {
    const Eigen::Vector2d corner = layer.origin.head<2>() + frame_.corner;
    std::array<double, 6> place{
        corner.x(), frame_.cell, 0.0, corner.y() + frame_.rows * frame_.cell, 0.0, -frame_.cell};
    dataset_->SetGeoTransform(place.data());
    if (layer.crs.empty()) return;
    const std::optional<OGRSpatialReference> srs = srsFrom(layer.crs);
    if (!srs) {
      throw UsageError(fmt::format("{}: its coordinate system cannot be understood", path.shown()));
    }
    dataset_->SetSpatialRef(&*srs);
  }

  template <typename T>
  void addBand(const Raster<T>& values, const GeoBand& band, const GeoLayer& layer) {
    if constexpr (std::is_same_v<T, Rgb>) {
      const Rgb* const first = values.row(frame_.rows - 1);
      addColour(&first->r, "red", GCI_RedBand, layer);
      addColour(&first->g, "green", GCI_GreenBand, layer);
      addColour(&first->b, "blue", GCI_BlueBand, layer);
    } else {
      const T* first = values.row(frame_.rows - 1);
      if constexpr (std::is_same_v<T, float>) {
        if (layer.add != 0.0) first = shift(values, layer.add).row(frame_.rows - 1);
      }
      GDALRasterBand& added = add(first, sizeof(T), kTypeOf<T>, layer);
      added.SetDescription(band.name.c_str());
      if (!band.unit.empty()) added.SetUnitType(band.unit.c_str());
      // Only one band of a GeoTIFF can be called grey; of others GDAL would say so in a file
      // beside.
      added.SetColorInterpretation(added.GetBand() == 1 ? GCI_GrayIndex : GCI_Undefined);
    }
  }

  void addColour(const std::uint8_t* first, const char* name, GDALColorInterp colour,
                 const GeoLayer& layer) {
    GDALRasterBand& added = add(first, sizeof(Rgb), GDT_Byte, layer);
    added.SetDescription(name);
    added.SetColorInterpretation(colour);
  }

  const Raster<float>& shift(const Raster<float>& values, double by) {
    Raster<float>& shifted = shifted_.emplace_back(frame_.rows, frame_.cols);
    parallelFor(static_cast<std::size_t>(frame_.rows), [&](std::size_t r) {
      const float* const from = values.row(static_cast<int>(r));
      float* const to = shifted.row(static_cast<int>(r));
      for (int c = 0; c < frame_.cols; ++c) {
        to[c] = static_cast<float>(static_cast<double>(from[c]) + by);
      }
    });
    return shifted;
  }

  /// `first`: of the northernmost row, which is the last in memory.
  GDALRasterBand& add(const void* first, std::size_t spacing, GDALDataType type,
                      const GeoLayer& layer) {
    std::array<char, 64> address{};
    CPLPrintPointer(address.data(), const_cast<void*>(first), address.size() - 1);
    const auto bytes = static_cast<std::ptrdiff_t>(spacing);
    const std::string pointer = fmt::format("DATAPOINTER={}", address.data());
    const std::string pixel = fmt::format("PIXELOFFSET={}", bytes);
    const std::string line = fmt::format("LINEOFFSET={}", -bytes * frame_.cols);
    const char* const options[] = {pointer.c_str(), pixel.c_str(), line.c_str(), nullptr};
    if (dataset_->AddBand(type, const_cast<char**>(options)) != CE_None) {
      throw Error(ErrorKind::kInternal,
                  fmt::format("GDAL takes no band of memory: {}", CPLGetLastErrorMsg()));
    }
    GDALRasterBand& band = *dataset_->GetRasterBand(dataset_->GetRasterCount());
    if (layer.nodata) band.SetNoDataValue(*layer.nodata);
    return band;
  }

  void setMask(const Raster<std::uint8_t>& mask) {
    bool done = dataset_->CreateMaskBand(GMF_PER_DATASET) == CE_None;
    std::vector<std::uint8_t> line(static_cast<std::size_t>(frame_.cols));
    for (int r = 0; done && r < frame_.rows; ++r) {
      const std::uint8_t* const from = mask.row(frame_.rows - 1 - r);
      for (int c = 0; c < frame_.cols; ++c) {
        line[static_cast<std::size_t>(c)] = from[c] != 0 ? 255 : 0;
      }
      done = dataset_->GetRasterBand(1)->GetMaskBand()->RasterIO(
                 GF_Write, 0, r, frame_.cols, 1, line.data(), frame_.cols, 1, GDT_Byte, 0, 0,
                 nullptr) == CE_None;
    }
    if (!done) throw Error(ErrorKind::kInternal, "GDAL makes no mask in memory");
  }

  GridFrame frame_;
  std::vector<Raster<float>> shifted_;  ///< before the dataset, which points into it
  GDALDatasetUniquePtr dataset_;
};

CPLStringList optionsOf(const GeoLayer& layer) {
  const bool floats = std::holds_alternative<const Raster<float>*>(layer.bands[0].values);
  CPLStringList options;
  // Deflate is what every reader of TIFF has. Of heights, the higher levels take four times as long
  // for files 4 % smaller; of codes, which are much alike, they take next to no time.
  options.SetNameValue("COMPRESS", "DEFLATE");
  options.SetNameValue("LEVEL", floats ? "1" : "6");
  options.SetNameValue("PREDICTOR", "YES");
  options.SetNameValue("BLOCKSIZE", "512");
  options.SetNameValue("BIGTIFF", "IF_SAFER");
  options.SetNameValue("OVERVIEW_RESAMPLING",
                       layer.overviews == Overviews::kAverage ? "AVERAGE" : "NEAREST");
  const std::size_t threads =
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  options.SetNameValue("NUM_THREADS", std::to_string(threads).c_str());
  return options;
}

/// Keeps GDAL quiet in this thread and holds the first thing that failed, which says why: what
/// follows from it is heard later.
class FirstFailure {
 public:
  FirstFailure() { CPLPushErrorHandlerEx(take, this); }
  ~FirstFailure() { CPLPopErrorHandler(); }
  FirstFailure(const FirstFailure&) = delete;
  FirstFailure& operator=(const FirstFailure&) = delete;

  bool happened() const { return happened_; }
  const std::string& reason() const { return reason_; }

 private:
  static void CPL_STDCALL take(CPLErr kind, CPLErrorNum /*number*/, const char* message) {
    auto& self = *static_cast<FirstFailure*>(CPLGetErrorHandlerUserData());
    if (kind < CE_Failure || self.happened_) return;
    self.happened_ = true;
    self.reason_ = message;
  }
  bool happened_ = false;
  std::string reason_;
};

/// For GDAL, which asks it now and then whether to go on.
int goOn(double /*done*/, const char* /*message*/, void* /*data*/) {
  try {
    throwIfInterrupted();
  } catch (const Interrupted&) {
    return FALSE;
  }
  return TRUE;
}

/// What the system says to more bytes in a file that could not be written; nothing when it takes
/// them. GDAL 3.10 and its libtiff keep it to themselves.
std::string refusal(const std::filesystem::path& file) {
  constexpr std::size_t kChunk = std::size_t{1} << 16;
  constexpr int kMost = 256;
  const int to = ::open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  if (to < 0) return std::generic_category().message(errno);
  const std::vector<char> zeros(kChunk);
  int error = 0;
  for (int i = 0; i < kMost && error == 0; ++i) {
    if (::write(to, zeros.data(), kChunk) < 0) error = errno;
  }
  if (::close(to) != 0 && error == 0) error = errno;
  return error == 0 ? "" : std::generic_category().message(error);
}

/// Whether all tiles of a band, at all of its scales, lie within so many bytes of its file.
bool tilesEndWithin(GDALRasterBand& band, std::uintmax_t bytes) {
  int width = 0, height = 0;
  band.GetBlockSize(&width, &height);
  const auto number = [&](const char* what, int x, int y) -> std::uintmax_t {
    const char* text = band.GetMetadataItem(fmt::format("{}_{}_{}", what, x, y).c_str(), "TIFF");
    return text == nullptr ? 0 : std::stoull(text);  // without: a tile of nothing
  };
  for (int y = 0; y * height < band.GetYSize(); ++y) {
    for (int x = 0; x * width < band.GetXSize(); ++x) {
      if (number("BLOCK_OFFSET", x, y) + number("BLOCK_SIZE", x, y) > bytes) return false;
    }
  }
  for (int i = 0; i < band.GetOverviewCount(); ++i) {
    if (!tilesEndWithin(*band.GetOverview(i), bytes)) return false;
  }
  return true;
}

/// What GDAL 3.10 holds back until it closes a file is lost without an error when the disk is full.
bool isWhole(const std::filesystem::path& file) {
  const GDALDatasetUniquePtr read(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER));
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(file, error);
  if (!read || error) return false;
  for (GDALRasterBand* band : read->GetBands()) {
    if (!tilesEndWithin(*band, bytes)) return false;
    const bool masked = (band->GetMaskFlags() & GMF_PER_DATASET) != 0;
    if (masked && !tilesEndWithin(*band->GetMaskBand(), bytes)) return false;
  }
  return true;
}

}  // namespace

void writeLayer(const OutputPath& path, const GeoLayer& layer) {
  checkLayer(path, layer);
  const FirstFailure failure;
  LayerInMemory source(path, layer);
  GDALDatasetUniquePtr written(driverOf("COG").CreateCopy(
      path.file().c_str(), &source.dataset(), FALSE, optionsOf(layer).List(), goOn, nullptr));
  const bool made = written != nullptr;
  // Some of a file is written, and of a full disk is heard, on closing only.
  written.reset();
  if (made && !failure.happened() && isWhole(path.file())) return;
  std::string reason = failure.reason();
  const std::string refused = refusal(path.file());
  if (reason.find(refused) == std::string::npos) reason += fmt::format(" ({})", refused);
  std::error_code ignored;
  std::filesystem::remove(path.file(), ignored);
  throwIfInterrupted();
  throw OutputError(fmt::format("{}: cannot be written as a GeoTIFF{}{}", path.shown(),
                                reason.empty() ? "" : ": ", reason));
}

}  // namespace agricolmap::io
