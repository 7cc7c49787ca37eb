// Points of text files: one point a line.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "agricolmap/io/cloud/point_source.hpp"

namespace agricolmap::io {

/// What a word of a line means.
struct AsciiColumn {
  enum class Use {
    kSkip,
    kList,  ///< a count and that many words, skipped
    kX,
    kY,
    kZ,
    kRed,
    kGreen,
    kBlue,
    kPacked,  ///< 0x00RRGGBB, as an integer or as the float with these bits
  };
  Use use = Use::kSkip;
};

/// Where the text stands and how to read it.
struct AsciiLayout {
  std::string name;       ///< file, for messages
  std::string_view text;  ///< from the first point's line on; more lines may follow the points
  std::size_t points = 0;
  std::vector<AsciiColumn> columns;
  ColourKind colour = ColourKind::kNone;
};

class AsciiSource : public PointSource {
 public:
  /// Counts the lines; throws InputError when there are fewer than `layout.points`.
  explicit AsciiSource(AsciiLayout layout);
  std::size_t points() const override { return layout_.points; }
  std::size_t chunks() const override { return pieces_.size(); }
  std::size_t firstPoint(std::size_t chunk) const override { return pieces_[chunk].first_point; }
  void decode(std::size_t chunk, const Sink& sink) const override;
  ColourKind colourKind() const override { return layout_.colour; }
  /// Text keeps all its digits.
  bool floatCoordinates() const override { return false; }
  bool dear() const override { return true; }
  /// Lines with words on them after the last point.
  std::size_t extraLines() const { return extra_lines_; }

 private:
  struct Piece {
    std::string_view text;
    std::size_t first_point = 0;
  };
  void decodeLine(std::string_view line, std::size_t point, PointBlock& block) const;
  void decodeColour(AsciiColumn::Use use, std::string_view word, std::size_t point,
                    PointBlock& block) const;
  [[noreturn]] void fail(std::size_t point, std::string_view what) const;

  AsciiLayout layout_;
  std::vector<Piece> pieces_;
  std::size_t extra_lines_ = 0;
};

}  // namespace agricolmap::io
