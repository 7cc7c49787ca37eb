#include "agricolmap/io/raster/raster_file.hpp"

#include <cpl_error.h>
#include <dlfcn.h>
#include <fmt/format.h>
#include <gdal_priv.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <limits>
#include <vector>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/robust.hpp"
#include "agricolmap/io/crs/srs.hpp"
#include "agricolmap/io/raster/raster_bands.hpp"
#include "agricolmap/io/raster/raster_dataset.hpp"

namespace agricolmap::io {

namespace {

constexpr int kStripRows = 256;
constexpr double kWhitePercentile = 0.995;
constexpr std::size_t kSampleSize = 1U << 20;

using Bands = ColourBands;

/// The pixels to read and how many come of it.
struct Section {
  PixelWindow window;  ///< whole blocks of `step`
  int step = 1;
  int rows = 0;
  int cols = 0;
};

Section sectionOf(GDALDataset& dataset, const RasterPart& part, const std::string& name) {
  const int cols = dataset.GetRasterXSize();
  const int rows = dataset.GetRasterYSize();
  Section section;
  section.window = part.window.value_or(PixelWindow{0, 0, cols, rows});
  PixelWindow& window = section.window;
  if (window.col < 0 || window.row < 0 || window.cols < 1 || window.rows < 1 ||
      window.cols > cols - window.col || window.rows > rows - window.row) {
    throw InputError(fmt::format(
        "{}: the window of {} x {} pixels at column {}, row {} is not within its {} x {} pixels",
        name, window.cols, window.rows, window.col, window.row, cols, rows));
  }
  section.step = std::clamp(part.step, 1, std::min(window.cols, window.rows));
  section.cols = window.cols / section.step;
  section.rows = window.rows / section.step;
  window.cols = section.cols * section.step;
  window.rows = section.rows * section.step;
  const double pixels = 1.0 * section.cols * section.rows;
  if (pixels > kMaxPixels) {
    throw InputError(fmt::format(
        "{}: {} x {} pixels are too many (limit {:.0e}); crop it with gdalwarp -te or thin it with "
        "gdal_translate -outsize",
        name, cols, rows, kMaxPixels));
  }
  return section;
}

void moveTo(const Section& section, RasterPlace& place) {
  if (!place.world_from_pixel) return;
  place.world_from_pixel->translate(Eigen::Vector2d(section.window.col, section.window.row));
  place.world_from_pixel->scale(section.step);
}

/// Reads a section of a band into `out`, `spacing` bytes from pixel to pixel.
void readBand(GDALRasterBand& band, const Section& section, GDALDataType type, void* out,
              int spacing, const std::string& name) {
  const PixelWindow& window = section.window;
  const int step = section.step;
  for (int row = 0; row < section.rows; row += kStripRows) {
    throwIfInterrupted();
    const int count = std::min(kStripRows, section.rows - row);
    auto* const to =
        static_cast<std::byte*>(out) + static_cast<std::ptrdiff_t>(row) * section.cols * spacing;
    if (band.RasterIO(GF_Read, window.col, window.row + row * step, window.cols, count * step, to,
                      section.cols, count, type, spacing,
                      static_cast<GSpacing>(section.cols) * spacing, nullptr) != CE_None) {
      failRaster(name, fmt::format("damaged or truncated at row {}", window.row + row * step));
    }
  }
}

/// Marks what alpha or the file's mask leaves out; false when it has neither.
bool applyMask(GDALDataset& dataset, const Section& section, GDALRasterBand& first,
               RasterImage& image) {
  GDALRasterBand* const alpha = alphaBandOf(dataset);
  const bool has_mask = (first.GetMaskFlags() & (GMF_PER_DATASET | GMF_ALPHA)) == GMF_PER_DATASET;
  if (alpha == nullptr && !has_mask) return false;
  if (has_mask) {
    readBand(*first.GetMaskBand(), section, GDT_Byte, image.valid.data(), 1, image.name);
  } else {
    Raster<float> values(image.valid.rows(), image.valid.cols());
    readBand(*alpha, section, GDT_Float32, values.data(), sizeof(float), image.name);
    auto mask = maskFromAlpha(values);
    if (!mask) {
      image.warnings.push_back(fmt::format(
          "{}: band {} is called transparency, but its values are data's; it takes nothing away",
          image.name, alpha->GetBand()));
      return false;
    }
    image.valid = *std::move(mask);
  }
  for (std::uint8_t& value : image.valid) value = value != 0 ? 1 : 0;
  image.transparent =
      static_cast<std::size_t>(std::count(image.valid.begin(), image.valid.end(), 0));
  return true;
}

struct NoData {
  std::array<double, 3> values{};
  bool declared = false;  ///< for all three bands

  explicit NoData(const Bands& bands) : declared(true) {
    for (std::size_t c = 0; c < 3; ++c) {
      int has = 0;
      values[c] = bands[c]->GetNoDataValue(&has);
      declared = declared && has != 0;
    }
  }
};

void readBytes(const Bands& bands, const Section& section, const NoData& nodata,
               RasterImage& image) {
  static_assert(sizeof(Rgb) == 3);
  auto* const first = reinterpret_cast<std::byte*>(image.colour.data());
  for (std::size_t c = 0; c < 3; ++c)
    readBand(*bands[c], section, GDT_Byte, first + c, 3, image.name);
  if (!nodata.declared) return;
  for (std::size_t i = 0; i < image.colour.size(); ++i) {
    const Rgb colour = image.colour[i];
    if (colour.r == nodata.values[0] && colour.g == nodata.values[1] &&
        colour.b == nodata.values[2]) {
      image.valid[i] = 0;
    }
  }
}

/// What values of more than 8 bits are multiplied by.
float whiteScale(const std::array<Raster<float>, 3>& values, const Raster<std::uint8_t>& valid,
                 bool integers) {
  const std::size_t step = std::max<std::size_t>(1, valid.size() / kSampleSize);
  std::vector<float> sample;
  for (std::size_t i = 0; i < valid.size(); i += step) {
    if (valid[i] == 0) continue;
    for (const Raster<float>& band : values) sample.push_back(band[i]);
  }
  if (sample.empty()) return 1.0F;
  if (integers && *std::max_element(sample.begin(), sample.end()) <= 255.0F) return 1.0F;
  const auto last = static_cast<double>(sample.size() - 1);
  const float white = valueAtRank(sample, static_cast<std::size_t>(kWhitePercentile * last));
  return white > 0.0F ? 255.0F / white : 1.0F;
}

void readWide(const Bands& bands, const Section& section, const NoData& nodata,
              RasterImage& image) {
  std::array<Raster<float>, 3> values;
  bool integers = true;
  for (std::size_t c = 0; c < 3; ++c) {
    values[c] = Raster<float>(image.colour.rows(), image.colour.cols());
    readBand(*bands[c], section, GDT_Float32, values[c].data(), sizeof(float), image.name);
    integers = integers && GDALDataTypeIsInteger(bands[c]->GetRasterDataType()) != 0;
  }
  for (std::size_t i = 0; i < image.valid.size(); ++i) {
    bool finite = true;
    bool all_nodata = nodata.declared;
    for (std::size_t c = 0; c < 3; ++c) {
      finite = finite && std::isfinite(values[c][i]);
      all_nodata = all_nodata && values[c][i] == static_cast<float>(nodata.values[c]);
    }
    if (!finite || all_nodata) image.valid[i] = 0;
  }
  const float scale = whiteScale(values, image.valid, integers);
  const auto byte = [&](float v) {
    return static_cast<std::uint8_t>(std::clamp(scale * v + 0.5F, 0.0F, 255.0F));
  };
  for (std::size_t i = 0; i < image.valid.size(); ++i) {
    if (image.valid[i] == 0) continue;
    image.colour[i] = {byte(values[0][i]), byte(values[1][i]), byte(values[2][i])};
  }
}

}  // namespace

void silenceGdal() {
  CPLSetErrorHandler(CPLQuietErrorHandler);
  // GDAL 3.10 leaves libtiff, where that is a library of its own, to say on stderr itself what
  // failed.
  using Handler = void (*)(const char*, const char*, va_list);
  using SetHandler = Handler (*)(Handler);
  for (const char* setter : {"TIFFSetErrorHandler", "TIFFSetWarningHandler"}) {
    if (void* const set = ::dlsym(RTLD_DEFAULT, setter)) {
      reinterpret_cast<SetHandler>(set)(nullptr);
    }
  }
}

RasterShape readRasterShape(const std::filesystem::path& path) {
  const QuietGdal quiet;
  const GDALDatasetUniquePtr dataset = openRaster(path);
  return {path.string(), dataset->GetRasterXSize(), dataset->GetRasterYSize(), placeOf(*dataset)};
}

RasterImage readRaster(const std::filesystem::path& path, const RasterOptions& options,
                       const RasterPart& part) {
  checkOptions(options);
  const QuietGdal quiet;
  const GDALDatasetUniquePtr dataset = openRaster(path);
  RasterImage image;
  image.name = path.string();
  image.place = placeOf(*dataset);
  const Bands bands = colourBandsOf(*dataset, options.bands, image.name);
  const Section section = sectionOf(*dataset, part, image.name);
  moveTo(section, image.place);
  image.colour = Raster<Rgb>(section.rows, section.cols);
  image.valid = Raster<std::uint8_t>(image.colour.rows(), image.colour.cols(), 1);
  const bool masked = applyMask(*dataset, section, *bands[0], image);
  const NoData nodata(bands);
  const auto is_byte = [](GDALRasterBand* b) { return b->GetRasterDataType() == GDT_Byte; };
  if (std::all_of(bands.begin(), bands.end(), is_byte)) {
    readBytes(bands, section, nodata, image);
  } else {
    readWide(bands, section, nodata, image);
  }
  if (!masked && !nodata.declared && options.black_is_nodata) {
    for (std::size_t i = 0; i < image.valid.size(); ++i) {
      if (image.colour[i] == Rgb{}) image.valid[i] = 0;
    }
  }
  if (std::all_of(image.valid.begin(), image.valid.end(), [](auto v) { return v == 0; })) {
    throw InputError(fmt::format("{}: no pixel of {} has data", image.name,
                                 part.window ? "the window" : "the picture"));
  }
  return image;
}

RasterHeights readHeights(const std::filesystem::path& path, const RasterPart& part) {
  const QuietGdal quiet;
  const GDALDatasetUniquePtr dataset = openRaster(path);
  RasterHeights heights;
  heights.name = path.string();
  heights.place = placeOf(*dataset);
  const Section section = sectionOf(*dataset, part, heights.name);
  moveTo(section, heights.place);
  heights.height = Raster<float>(section.rows, section.cols);
  GDALRasterBand& band = *dataset->GetRasterBand(1);
  readBand(band, section, GDT_Float32, heights.height.data(), sizeof(float), heights.name);
  const double unit = heightUnitOf(*dataset, band, heights.name, heights.warnings);
  const double scale = band.GetScale();
  const double shift = band.GetOffset();
  int has_nodata = 0;
  const auto nodata = static_cast<float>(band.GetNoDataValue(&has_nodata));
  std::size_t valid = 0;
  for (float& height : heights.height) {
    if (!std::isfinite(height) || (has_nodata != 0 && height == nodata)) {
      height = std::numeric_limits<float>::quiet_NaN();
    } else {
      height = static_cast<float>(unit * (scale * static_cast<double>(height) + shift));
      ++valid;
    }
  }
  if (valid == 0) throw InputError(fmt::format("{}: no pixel has a height", heights.name));
  refusePictureAsHeights(*dataset, heights.height, heights.name);
  if (unit != 1.0) {
    heights.warnings.push_back(
        fmt::format("{}: its heights are in units of {} m; brought to metres", heights.name, unit));
  }
  return heights;
}

}  // namespace agricolmap::io
