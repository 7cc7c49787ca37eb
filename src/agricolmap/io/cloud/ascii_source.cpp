#include "agricolmap/io/cloud/ascii_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/io/text/text.hpp"

namespace agricolmap::io {
namespace {

/// Fixed, so that pieces do not depend on the number of threads.
constexpr std::size_t kPieceBytes = 1U << 18;

bool hasWords(std::string_view line) { return !std::all_of(line.begin(), line.end(), isBlank); }

std::size_t countLines(std::string_view text) {
  std::size_t lines = 0;
  while (!text.empty()) lines += hasWords(takeLine(text)) ? 1 : 0;
  return lines;
}

/// Pieces of about equal size that end where lines end.
std::vector<std::string_view> splitAtLineEnds(std::string_view text) {
  std::vector<std::string_view> pieces;
  while (!text.empty()) {
    std::size_t size = text.size();
    if (size > kPieceBytes) {
      const std::size_t end = text.find('\n', kPieceBytes);
      if (end != std::string_view::npos) size = end + 1;
    }
    pieces.push_back(text.substr(0, size));
    text.remove_prefix(size);
  }
  return pieces;
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

}  // namespace

AsciiSource::AsciiSource(AsciiLayout layout) : layout_(std::move(layout)) {
  const auto texts = splitAtLineEnds(layout_.text);
  std::vector<std::size_t> counts(texts.size());
  parallelFor(texts.size(), [&](std::size_t i) { counts[i] = countLines(texts[i]); });
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
    const auto bits = parsePacked(word);
    if (!bits) {
      fail(point, fmt::format("'{}' is no packed colour; write the cloud as binary", word));
    }
    block.rgb[i] = {static_cast<std::uint8_t>(*bits >> 16), static_cast<std::uint8_t>(*bits >> 8),
                    static_cast<std::uint8_t>(*bits)};
    return;
  }
  const std::size_t channel = static_cast<std::size_t>(use) - static_cast<std::size_t>(Use::kRed);
  if (layout_.colour == ColourKind::kByte) {
    const auto byte = parseByte(word);
    if (!byte) fail(point, fmt::format("'{}' is no colour of 0..255", word));
    Rgb& rgb = block.rgb[i];
    (channel == 0 ? rgb.r : channel == 1 ? rgb.g : rgb.b) = *byte;
    return;
  }
  const auto value = parseNumber(word);
  if (!value) fail(point, fmt::format("'{}' is no number", word));
  block.wide[channel][i] = static_cast<float>(*value);
}

void AsciiSource::decodeLine(std::string_view line, std::size_t point, PointBlock& block) const {
  using Use = AsciiColumn::Use;
  for (const AsciiColumn& column : layout_.columns) {
    const std::string_view word = takeWord(line);
    if (word.empty()) fail(point, "has fewer values than the header says");
    switch (column.use) {
      case Use::kSkip:
        break;
      case Use::kList: {
        const auto count = parseInteger(word);
        if (!count || *count < 0) fail(point, fmt::format("'{}' is no list length", word));
        for (std::int64_t k = 0; k < *count; ++k) {
          if (takeWord(line).empty()) fail(point, "has a list shorter than its length says");
        }
        break;
      }
      case Use::kX:
      case Use::kY:
      case Use::kZ: {
        const auto value = parseNumber(word);
        if (!value) fail(point, fmt::format("'{}' is no number", word));
        const auto axis = static_cast<std::size_t>(column.use) - static_cast<std::size_t>(Use::kX);
        block.xyz[axis][block.count] = *value;
        break;
      }
      case Use::kRed:
      case Use::kGreen:
      case Use::kBlue:
      case Use::kPacked:
        decodeColour(column.use, word, point, block);
    }
  }
  if (!takeWord(line).empty()) fail(point, "has more values than the header says");
}

void AsciiSource::decode(std::size_t chunk, const Sink& sink) const {
  std::string_view text = pieces_[chunk].text;
  std::size_t point = pieces_[chunk].first_point;
  PointBlock block;
  while (!text.empty() && point < layout_.points) {
    const std::string_view line = takeLine(text);
    if (!hasWords(line)) continue;
    decodeLine(line, point, block);
    ++point;
    if (++block.count == PointBlock::kCapacity) {
      sink(block);
      block.count = 0;
    }
  }
  if (block.count > 0) sink(block);
}

}  // namespace agricolmap::io
