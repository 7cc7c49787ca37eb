#include "agricolmap/io/cloud/text_move.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/io/text/text.hpp"

namespace agricolmap::io {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 12;  ///< items that one thread moves at a time
constexpr std::size_t kTogether = 16;
constexpr std::size_t kSamples = 1024;

bool isGap(char c) { return isBlank(c) || c == '\n'; }

/// The next word wherever its line ends; empty when there is none left.
std::string_view nextWord(std::string_view& text) {
  std::size_t begin = 0;
  while (begin < text.size() && isGap(text[begin])) ++begin;
  std::size_t end = begin;
  while (end < text.size() && !isGap(text[end])) ++end;
  const std::string_view word = text.substr(begin, end - begin);
  text.remove_prefix(end);
  return word;
}

/// Words of an item: of a list its length alone. Nothing where the text ends before.
bool takeItem(std::string_view& text, const TextItem& item, std::vector<std::string_view>& words) {
  words.clear();
  for (const bool list : item.lists) {
    words.push_back(nextWord(text));
    const auto length = list ? parseInteger(words.back()) : 0;
    if (words.back().empty() || !length || *length < 0) return false;
    for (std::int64_t i = 0; i < *length; ++i) {
      if (nextWord(text).empty()) return false;
    }
  }
  return true;
}

/// Three values of item number `index`.
Eigen::Vector3d numbersOf(const std::vector<std::string_view>& words, const ThreeFields& fields,
                          const TextItem& item, std::size_t index, const std::string& file) {
  Eigen::Vector3d numbers;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string_view word = words[fields[axis]];
    const auto number = parseNumber(word);
    if (!number) {
      throw InputError(
          fmt::format("{}: {} {}: '{}' is no number", file, item.name, index + 1, word));
    }
    numbers[static_cast<Eigen::Index>(axis)] = *number;
  }
  return numbers;
}

/// Items that are moved together, and what becomes of them.
struct Piece {
  std::string_view text;
  std::size_t first = 0;
  std::size_t count = 0;
  std::string moved;
  MoveTally tally;
};

class Pieces {
 public:
  Pieces(const TextItem& item, const PointFields& fields, const PointMover& mover,
         const std::string& file)
      : item_(item), fields_(fields), mover_(mover), file_(file) {}

  void move(Piece& piece) const {
    piece.moved.clear();
    piece.tally = MoveTally();
    std::string_view rest = piece.text;
    const char* done = piece.text.data();
    std::vector<std::vector<std::string_view>> items;
    std::vector<std::string_view> words;
    for (std::size_t begin = 0; begin < piece.count; begin += items.size()) {
      CoordinateBlock block;
      block.count = std::min(CoordinateBlock::kCapacity, piece.count - begin);
      items.assign(block.count, {});
      for (std::size_t i = 0; i < block.count; ++i) {
        takeItem(rest, item_, items[i]);
        block.set(i, vectorOf(items[i], fields_.xyz, piece.first + begin + i));
      }
      piece.tally += mover_.move(block);
      for (std::size_t i = 0; i < block.count; ++i) {
        done = put(items[i], block.point(i), piece.first + begin + i, done, piece.moved);
      }
    }
    piece.moved.append(done, piece.text.data() + piece.text.size());
  }

 private:
  Eigen::Vector3d vectorOf(const std::vector<std::string_view>& words, const ThreeFields& fields,
                           std::size_t item) const {
    return numbersOf(words, fields, item_, item, file_);
  }

  /// Appends what stands from `done` on to the item's last word that changes; returns its end.
  const char* put(const std::vector<std::string_view>& words, const Eigen::Vector3d& point,
                  std::size_t item, const char* done, std::string& out) const {
    std::vector<double> values(words.size(), 0.0);
    std::vector<std::size_t> changed(fields_.xyz.begin(), fields_.xyz.end());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      values[fields_.xyz[axis]] = point[static_cast<Eigen::Index>(axis)];
    }
    if (fields_.normal) {
      const Eigen::Vector3d normal = mover_.turned(vectorOf(words, *fields_.normal, item));
      for (std::size_t axis = 0; axis < 3; ++axis) {
        values[(*fields_.normal)[axis]] = normal[static_cast<Eigen::Index>(axis)];
        changed.push_back((*fields_.normal)[axis]);
      }
    }
    std::sort(changed.begin(), changed.end());
    for (const std::size_t i : changed) {
      out.append(done, static_cast<std::size_t>(words[i].data() - done));
      done = words[i].data() + words[i].size();
      if (std::isnan(values[i])) {
        out += "nan";
      } else {
        fmt::format_to(std::back_inserter(out), "{:.6f}", values[i]);
      }
    }
    return done;
  }

  const TextItem& item_;
  const PointFields& fields_;
  const PointMover& mover_;
  const std::string& file_;
};

}  // namespace

std::string_view takeItems(std::string_view& text, const TextItem& item, std::size_t count,
                           const std::string& file) {
  const std::string_view all = text;
  std::vector<std::string_view> words;
  for (std::size_t i = 0; i < count; ++i) {
    if (takeItem(text, item, words)) continue;
    throw InputError(
        fmt::format("{}: truncated or damaged: {} {} is not whole", file, item.name, i + 1));
  }
  return all.substr(0, all.size() - text.size());
}

std::vector<Eigen::Vector3d> samplesOf(std::string_view text, const TextItem& item,
                                       const PointFields& fields, std::size_t count,
                                       const std::string& file) {
  std::vector<Eigen::Vector3d> samples;
  std::vector<std::string_view> words;
  for (std::size_t i = 0; i < std::min(count, kSamples); ++i) {
    if (!takeItem(text, item, words)) break;
    samples.push_back(numbersOf(words, fields.xyz, item, i, file));
  }
  return samples;
}

MoveTally writeMoved(std::string_view& text, const TextItem& item, const PointFields& fields,
                     std::size_t count, const PointMover& mover, const std::string& file,
                     FileSink& sink, const CopyProgress& progress) {
  const Pieces pieces(item, fields, mover, file);
  std::vector<Piece> batch(kTogether);
  MoveTally tally;
  for (std::size_t begin = 0; begin < count;) {
    std::size_t used = 0;
    for (; used < kTogether && begin < count; ++used) {
      Piece& piece = batch[used];
      piece.first = begin;
      piece.count = std::min(kPiece, count - begin);
      try {
        piece.text = takeItems(text, item, piece.count, file);
      } catch (const InputError&) {
        throw InputError(fmt::format(
            "{}: truncated: the header announces {} points, and they end before number {}", file,
            count, begin + piece.count));
      }
      begin += piece.count;
    }
    parallelFor(used, [&](std::size_t i) { pieces.move(batch[i]); });
    for (std::size_t i = 0; i < used; ++i) {
      throwIfInterrupted();
      sink.write(batch[i].moved);
      tally += batch[i].tally;
    }
    if (progress) progress(begin, count);
  }
  return tally;
}

}  // namespace agricolmap::io
