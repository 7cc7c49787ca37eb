// Points of text files: one point a line, or word after word.
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
  std::string name;        ///< file, for messages
  std::string_view text;   ///< from the first point's line on; more lines may follow the points
  std::size_t points = 0;  ///< 0: one for each line
  std::vector<AsciiColumn> columns;
  ColourKind colour = ColourKind::kNone;
  char line_end = '\n';
  bool last = true;                              ///< the points are the last that is in the file
  char separator = ' ';                          ///< of words: any blanks, or this one
  bool decimal_comma = false;                    ///< "1,5" is one and a half
  std::string_view told_by = "the header says";  ///< how long lines are
  /// What the text lies in, to be released while it is looked through; none where it is in memory.
  const MappedFile* file = nullptr;
};

class AsciiSource : public PointSource {
 public:
  /// Counts the lines; throws InputError when there are fewer than `layout.points`. Where the first
  /// line is not as long as a point, and all words of the file make the points announced, to the
  /// word, line ends mean nothing.
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
  std::vector<std::string_view> splitAtLineEnds() const;
  /// What `count` says of each of the texts.
  template <typename Count>
  std::vector<std::size_t> countedIn(const std::vector<std::string_view>& texts,
                                     const Count& count) const;
  void release() const;
  /// Words per point, where that is always the same.
  std::optional<std::size_t> wordsPerPoint() const;
  /// Makes pieces of words when that is what the text is.
  bool takeAsWords(const std::vector<std::string_view>& texts);
  void takeAsLines(const std::vector<std::string_view>& texts);
  /// The point at the beginning of `text`; what was read is taken off it.
  void decodePoint(std::string_view& text, std::size_t point, PointBlock& block) const;
  void decodeColour(AsciiColumn::Use use, std::string_view word, std::size_t point,
                    PointBlock& block) const;
  void skipList(std::string_view word, std::string_view& text, std::size_t point) const;
  std::string_view wordOf(std::string_view& text) const;
  [[noreturn]] void fail(std::size_t point, std::string_view what) const;

  AsciiLayout layout_;
  bool by_words_ = false;
  std::vector<Piece> pieces_;
  std::size_t extra_lines_ = 0;
};

}  // namespace agricolmap::io
