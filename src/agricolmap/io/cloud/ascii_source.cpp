#include "agricolmap/io/cloud/ascii_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/io/text/commas.hpp"
#include "agricolmap/io/text/text.hpp"

namespace agricolmap::io {
namespace {

/// Fixed, so that pieces do not depend on the number of threads.
constexpr std::size_t kPieceBytes = 1U << 18;
/// Pieces that are looked through before their memory is released.
constexpr std::size_t kHeld = 64;

bool hasWords(std::string_view line) { return !std::all_of(line.begin(), line.end(), isBlank); }

std::size_t countLines(std::string_view text, char line_end) {
  std::size_t lines = 0;
  while (!text.empty()) lines += hasWords(takeLine(text, line_end)) ? 1 : 0;
  return lines;
}

/// As takeWord, over the ends of lines.
std::string_view takeWordOfText(std::string_view& text) {
  const auto between = [](char c) { return isBlank(c) || c == '\n'; };
  std::size_t begin = 0;
  while (begin < text.size() && between(text[begin])) ++begin;
  std::size_t end = begin;
  while (end < text.size() && !between(text[end])) ++end;
  const std::string_view word = text.substr(begin, end - begin);
  text.remove_prefix(end);
  return word;
}

std::size_t countWords(std::string_view text) {
  std::size_t words = 0;
  while (!takeWordOfText(text).empty()) ++words;
  return words;
}

/// Bits 0x00RRGGBB written as an integer, or as the float that has these bits. A word of digits is
/// an integer: as floats, packed colours are tiny or huge and never come without an exponent.
std::optional<std::uint32_t> parsePacked(std::string_view word) {
  if (const auto integer = parseInteger(word)) {
    if (*integer < -std::int64_t{0x80000000} || *integer > std::int64_t{0xFFFFFFFF}) {
      return std::nullopt;
    }
    return static_cast<std::uint32_t>(*integer);
  }
  const auto number = parseNumber(word);
  // A NaN lost its bits when it was printed.
  if (!number || !std::isfinite(*number)) return std::nullopt;
  return std::bit_cast<std::uint32_t>(static_cast<float>(*number));
}

std::optional<std::uint8_t> parseByte(std::string_view word) {
  unsigned value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error == std::errc{} && end == word.data() + word.size()) {
    if (value > 255) return std::nullopt;
    return static_cast<std::uint8_t>(value);
  }
  const auto number = parseNumber(word);  // "255.0"
  if (!number || !(*number >= 0.0 && *number <= 255.0) || *number != std::floor(*number)) {
    return std::nullopt;
  }
  return static_cast<std::uint8_t>(*number);
}

/// Colours are numbered from kRed on.
constexpr std::size_t kColours = 4;
std::size_t colourOf(AsciiColumn::Use use) {
  return static_cast<std::size_t>(use) - static_cast<std::size_t>(AsciiColumn::Use::kRed);
}

bool isNan(std::string_view word) {
  const auto number = parseNumber(word);
  return number && std::isnan(*number);
}

bool isPoint(const PointBlock& block, std::size_t i) {
  return std::isfinite(block.xyz[0][i]) && std::isfinite(block.xyz[1][i]) &&
         std::isfinite(block.xyz[2][i]);
}

}  // namespace

AsciiSource::AsciiSource(AsciiLayout layout) : layout_(std::move(layout)) {
  const auto texts = splitAtLineEnds();
  if (!takeAsWords(texts)) takeAsLines(texts);
}

void AsciiSource::release() const {
  if (layout_.file != nullptr) layout_.file->release();
}

/// Pieces of about equal size that end where lines end.
std::vector<std::string_view> AsciiSource::splitAtLineEnds() const {
  std::vector<std::string_view> pieces;
  for (std::string_view text = layout_.text; !text.empty();) {
    std::size_t size = text.size();
    if (size > kPieceBytes) {
      const std::size_t end = text.find(layout_.line_end, kPieceBytes);
      if (end != std::string_view::npos) size = end + 1;
    }
    pieces.push_back(text.substr(0, size));
    text.remove_prefix(size);
    if (pieces.size() % kHeld == 0) release();
  }
  return pieces;
}

template <typename Count>
std::vector<std::size_t> AsciiSource::countedIn(const std::vector<std::string_view>& texts,
                                                const Count& count) const {
  std::vector<std::size_t> counts(texts.size());
  for (std::size_t begin = 0; begin < texts.size(); begin += kHeld) {
    parallelFor(std::min(kHeld, texts.size() - begin),
                [&](std::size_t i) { counts[begin + i] = count(texts[begin + i]); });
    release();
  }
  return counts;
}

std::optional<std::size_t> AsciiSource::wordsPerPoint() const {
  const auto is_list = [](const AsciiColumn& c) { return c.use == AsciiColumn::Use::kList; };
  if (std::any_of(layout_.columns.begin(), layout_.columns.end(), is_list)) return std::nullopt;
  return layout_.columns.size();
}

bool AsciiSource::takeAsWords(const std::vector<std::string_view>& texts) {
  const auto each = wordsPerPoint();
  if (!each || !layout_.last || layout_.points == 0) return false;
  std::string_view rest = layout_.text;
  std::string_view first;
  while (!rest.empty() && !hasWords(first)) first = takeLine(rest, layout_.line_end);
  if (splitWords(first).size() == *each) return false;
  const std::vector<std::size_t> counts = countedIn(texts, countWords);
  std::size_t words = 0;
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    // The first point that begins in this piece of the text.
    const std::size_t point = (words + *each - 1) / *each;
    Piece piece{
        layout_.text.substr(static_cast<std::size_t>(texts[i].data() - layout_.text.data())),
        point};
    for (std::size_t k = words; k < point * *each; ++k) takeWordOfText(piece.text);
    words += counts[i];
    if (point * *each < words) pieces.push_back(piece);
  }
  if (words % *each != 0 || words / *each != layout_.points) return false;
  by_words_ = true;
  pieces_ = std::move(pieces);
  return true;
}

void AsciiSource::takeAsLines(const std::vector<std::string_view>& texts) {
  const std::vector<std::size_t> counts =
      countedIn(texts, [&](std::string_view text) { return countLines(text, layout_.line_end); });
  if (layout_.points == 0) {
    layout_.points = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
  }
  std::size_t lines = 0;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    if (lines < layout_.points && counts[i] > 0) pieces_.push_back({texts[i], lines});
    lines += counts[i];
  }
  if (lines < layout_.points) {
    throw InputError(fmt::format(
        "{}: truncated: the header announces {} points, but only {} lines of data follow",
        layout_.name, layout_.points, lines));
  }
  extra_lines_ = lines - layout_.points;
}

void AsciiSource::fail(std::size_t point, std::string_view what) const {
  throw InputError(fmt::format("{}: point {}: {}", layout_.name, point + 1, what));
}

void AsciiSource::decodeColour(AsciiColumn::Use use, std::string_view word, std::size_t point,
                               PointBlock& block) const {
  using Use = AsciiColumn::Use;
  const std::size_t i = block.count;
  if (use == Use::kPacked) {
    auto bits = parsePacked(word);
    if (!bits && isNan(word) && !isPoint(block, i)) bits = 0;  // dropped anyway
    if (!bits) {
      fail(point, fmt::format("'{}' is no packed colour; write the cloud as binary", word));
    }
    block.rgb[i] = {static_cast<std::uint8_t>(*bits >> 16), static_cast<std::uint8_t>(*bits >> 8),
                    static_cast<std::uint8_t>(*bits)};
    return;
  }
  const std::size_t channel = colourOf(use);
  if (layout_.colour == ColourKind::kByte) {
    auto byte = parseByte(word);
    if (!byte && isNan(word)) {
      // As with colours that are floats: without one, the point is left out.
      block.xyz[0][i] = std::numeric_limits<double>::quiet_NaN();
      byte = 0;
    }
    if (!byte) fail(point, fmt::format("'{}' is no colour of 0..255", word));
    Rgb& rgb = block.rgb[i];
    (channel == 0 ? rgb.r : channel == 1 ? rgb.g : rgb.b) = *byte;
    return;
  }
  const auto value = layout_.decimal_comma ? parseCommaNumber(word) : parseNumber(word);
  if (!value) fail(point, fmt::format("'{}' is no number", word));
  block.wide[channel][i] = static_cast<float>(*value);
}

std::string_view AsciiSource::wordOf(std::string_view& text) const {
  if (by_words_) return takeWordOfText(text);
  return layout_.separator == ' ' ? takeWord(text) : takeField(text, layout_.separator);
}

void AsciiSource::skipList(std::string_view word, std::string_view& text, std::size_t point) const {
  const auto count = parseInteger(word);
  if (!count || *count < 0) fail(point, fmt::format("'{}' is no list length", word));
  for (std::int64_t k = 0; k < *count; ++k) {
    if (wordOf(text).empty()) fail(point, "has a list shorter than its length says");
  }
}

void AsciiSource::decodePoint(std::string_view& text, std::size_t point, PointBlock& block) const {
  using Use = AsciiColumn::Use;
  std::array<std::string_view, kColours> colours;  // decoded when it is known where the point is
  for (const AsciiColumn& column : layout_.columns) {
    const std::string_view word = wordOf(text);
    const bool left_empty = column.use == Use::kSkip && layout_.separator != ' ';
    if (word.empty() && !left_empty)
      fail(point, fmt::format("has fewer values than {}", layout_.told_by));
    switch (column.use) {
      case Use::kSkip:
        break;
      case Use::kList:
        skipList(word, text, point);
        break;
      case Use::kX:
      case Use::kY:
      case Use::kZ: {
        const auto value = layout_.decimal_comma ? parseCommaNumber(word) : parseNumber(word);
        if (!value) fail(point, fmt::format("'{}' is no number", word));
        const auto axis = static_cast<std::size_t>(column.use) - static_cast<std::size_t>(Use::kX);
        block.xyz[axis][block.count] = *value;
        break;
      }
      case Use::kRed:
      case Use::kGreen:
      case Use::kBlue:
      case Use::kPacked:
        colours[colourOf(column.use)] = word;
    }
  }
  for (const Use use : {Use::kRed, Use::kGreen, Use::kBlue, Use::kPacked}) {
    const std::string_view word = colours[colourOf(use)];
    if (!word.empty()) decodeColour(use, word, point, block);
  }
  if (!by_words_ && hasWords(text)) {
    fail(point, fmt::format("has more values than {}", layout_.told_by));
  }
}

void AsciiSource::decode(std::size_t chunk, const Sink& sink) const {
  std::string_view text = pieces_[chunk].text;
  std::size_t point = pieces_[chunk].first_point;
  const std::size_t end =
      chunk + 1 < pieces_.size() ? pieces_[chunk + 1].first_point : layout_.points;
  PointBlock block;
  while (!text.empty() && point < end) {
    if (by_words_) {
      decodePoint(text, point, block);
    } else {
      std::string_view line = takeLine(text, layout_.line_end);
      if (!hasWords(line)) continue;
      decodePoint(line, point, block);
    }
    ++point;
    if (++block.count == PointBlock::kCapacity) {
      sink(block);
      block.count = 0;
    }
  }
  if (block.count > 0) sink(block);
}

}  // namespace agricolmap::io
