#include "agricolmap/io/raster/mosaic_writer.hpp"

#include <cpl_conv.h>
#include <cpl_minixml.h>
#include <fmt/format.h>

#include <array>
#include <memory>
#include <optional>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/crs/srs.hpp"
#include "agricolmap/io/output/file_sink.hpp"

namespace agricolmap::io {
namespace {

struct DestroyTree {
  void operator()(CPLXMLNode* tree) const { CPLDestroyXMLNode(tree); }
};
struct FreeText {
  void operator()(char* text) const { CPLFree(text); }
};

void setNumber(CPLXMLNode* node, const char* key, int value) {
  CPLSetXMLValue(node, key, std::to_string(value).c_str());
}

/// A rectangle of cells, from the north-west.
void addRectangle(CPLXMLNode* source, const char* name, int col, int row, int cols, int rows) {
  CPLXMLNode* const rectangle = CPLCreateXMLNode(source, CXT_Element, name);
  setNumber(rectangle, "#xOff", col);
  setNumber(rectangle, "#yOff", row);
  setNumber(rectangle, "#xSize", cols);
  setNumber(rectangle, "#ySize", rows);
}

/// `band`: "2", or "mask,1".
void addPiece(CPLXMLNode* band_node, const Mosaic& mosaic, const MosaicPiece& piece,
              const std::string& band, const char* kind) {
  CPLXMLNode* const source = CPLCreateXMLNode(band_node, CXT_Element, kind);
  CPLSetXMLValue(source, "SourceFilename", piece.file.c_str());
  CPLSetXMLValue(source, "SourceFilename.#relativeToVRT", "1");
  CPLCreateXMLElementAndValue(source, "SourceBand", band.c_str());
  addRectangle(source, "SrcRect", 0, 0, piece.cols / piece.cells, piece.rows / piece.cells);
  addRectangle(source, "DstRect", piece.col, mosaic.frame.rows - piece.row - piece.rows, piece.cols,
               piece.rows);
  if (mosaic.colour) {
    CPLCreateXMLElementAndValue(source, "UseMaskBand", "true");
  } else {
    CPLCreateXMLElementAndValue(source, "NODATA", "nan");
  }
}

CPLXMLNode* addBand(CPLXMLNode* parent, const char* type, int number) {
  CPLXMLNode* const band = CPLCreateXMLNode(parent, CXT_Element, "VRTRasterBand");
  CPLSetXMLValue(band, "#dataType", type);
  if (number > 0) setNumber(band, "#band", number);
  return band;
}

void addFloats(CPLXMLNode* root, const Mosaic& mosaic) {
  CPLXMLNode* const band = addBand(root, "Float32", 1);
  CPLCreateXMLElementAndValue(band, "Description", mosaic.name.c_str());
  CPLCreateXMLElementAndValue(band, "NoDataValue", "nan");
  if (!mosaic.unit.empty()) CPLCreateXMLElementAndValue(band, "UnitType", mosaic.unit.c_str());
  CPLCreateXMLElementAndValue(band, "ColorInterp", "Gray");
  for (const MosaicPiece& piece : mosaic.pieces) {
    addPiece(band, mosaic, piece, std::to_string(piece.band), "ComplexSource");
  }
}

void addColours(CPLXMLNode* root, const Mosaic& mosaic) {
  int number = 0;
  for (const char* name : {"Red", "Green", "Blue"}) {
    CPLXMLNode* const band = addBand(root, "Byte", ++number);
    CPLCreateXMLElementAndValue(band, "ColorInterp", name);
    for (const MosaicPiece& piece : mosaic.pieces) {
      addPiece(band, mosaic, piece, std::to_string(piece.band + number - 1), "ComplexSource");
    }
  }
  CPLXMLNode* const mask = addBand(CPLCreateXMLNode(root, CXT_Element, "MaskBand"), "Byte", 0);
  for (const MosaicPiece& piece : mosaic.pieces) {
    addPiece(mask, mosaic, piece, "mask,1", "ComplexSource");
  }
}

void addPlace(const OutputPath& path, CPLXMLNode* root, const Mosaic& mosaic) {
  if (!mosaic.crs.empty()) {
    const std::optional<OGRSpatialReference> srs = srsFrom(mosaic.crs);
    if (!srs) {
      throw UsageError(fmt::format("{}: its coordinate system cannot be understood", path.shown()));
    }
    char* wkt = nullptr;
    const std::array<const char*, 2> options{"FORMAT=WKT2_2018", nullptr};
    srs->exportToWkt(&wkt, options.data());
    const std::unique_ptr<char, FreeText> kept(wkt);
    CPLCreateXMLElementAndValue(root, "SRS", wkt);
    CPLSetXMLValue(root, "SRS.#dataAxisToSRSAxisMapping", "1,2");
  }
  const Eigen::Vector2d corner = mosaic.origin.head<2>() + mosaic.frame.corner;
  CPLCreateXMLElementAndValue(
      root, "GeoTransform",
      fmt::format("{:.17g}, {:.17g}, 0, {:.17g}, 0, {:.17g}", corner.x(), mosaic.frame.cell,
                  corner.y() + mosaic.frame.rows * mosaic.frame.cell, -mosaic.frame.cell)
          .c_str());
}

}  // namespace

void writeMosaic(const OutputPath& path, const Mosaic& mosaic) {
  const std::unique_ptr<CPLXMLNode, DestroyTree> root(
      CPLCreateXMLNode(nullptr, CXT_Element, "VRTDataset"));
  setNumber(root.get(), "#rasterXSize", mosaic.frame.cols);
  setNumber(root.get(), "#rasterYSize", mosaic.frame.rows);
  addPlace(path, root.get(), mosaic);
  if (mosaic.colour) {
    addColours(root.get(), mosaic);
  } else {
    addFloats(root.get(), mosaic);
  }
  const std::unique_ptr<char, FreeText> text(CPLSerializeXMLTree(root.get()));
  writeText(path, text.get());
}

}  // namespace agricolmap::io
