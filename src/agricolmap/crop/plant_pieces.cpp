#include "agricolmap/crop/plant_pieces.hpp"

#include <algorithm>
#include <cmath>

#include "agricolmap/core/robust.hpp"

namespace agricolmap::crop {

namespace {

constexpr double kSmoothing = 0.13;  // of the curve, in spacings
constexpr double kSharpening = 2.0;
constexpr double kFineSmoothing = 0.09;  // where pieces are to be too many rather than too few
constexpr double kFineSharpening = 3.0;
constexpr double kLeastTop = 0.04;     // of a usual plant's
constexpr double kNoiseTop = 1.0;      // deviations of the soil's noise in the sharpened curve
constexpr double kLeastParted = 0.04;  // less is a shoulder of the same hill
constexpr double kNearest = 0.15;      // of tops, in spacings
constexpr double kEdge = 0.25;         // of a plant's top: where its green ends
constexpr double kLongPiece = 1.0;     // in spacings: may be two
constexpr double kPartLength = 0.75;   // in spacings, of the parts of such a one
constexpr int kMostParts = 4;

/// How deep a valley two tops need between them to be two plants, by their distance in spacings:
/// plants of one drill seldom stand nearer than half a spacing, leaves of one plant do.
double depthNeeded(double spacings) {
  if (spacings < 0.33) return 2.0;
  return std::clamp(0.5 - 1.2 * (spacings - 0.33), 0.06, 0.5);
}

/// A top of the curve.
struct Top {
  int index = 0;
  double height = 0.0;
};

std::vector<Top> topsOf(const RowProfile& curve) {
  std::vector<Top> tops;
  const std::vector<double>& y = curve.green;
  const int count = curve.size();
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const bool up = i == 0 || y[k] > y[k - 1];
    const bool down = i + 1 == count || y[k] >= y[k + 1];
    if (up && down && y[k] > 0.0) tops.push_back({i, y[k]});
  }
  return tops;
}

/// Smoothed, and what stands out of a neighbourhood twice as wide made to stand out more: two
/// plants that the map blurs into one hill become two tops again.
RowProfile sharpened(const RowProfile& profile, double sigma, double strength) {
  RowProfile fine = smoothed(profile, sigma);
  const RowProfile wide = smoothed(profile, 2.0 * sigma);
  for (std::size_t i = 0; i < fine.green.size(); ++i) {
    fine.green[i] += strength * (fine.green[i] - wide.green[i]);
  }
  // Of white noise under Gaussians of σ and 2σ, which correlate by √0.8.
  const double own = 1.0 + strength;
  fine.noise *=
      std::sqrt(own * own + 0.5 * strength * strength - 2.0 * own * strength * std::sqrt(0.4));
  return fine;
}

int lowestBetween(const RowProfile& curve, int from, int to) {
  const auto begin = curve.green.begin();
  return static_cast<int>(std::min_element(begin + from, begin + to + 1) - begin);
}

/// How clearly two neighbouring tops part.
double parting(const RowProfile& curve, const Top& a, const Top& b) {
  const int valley = lowestBetween(curve, a.index, b.index);
  const double low = std::max(0.0, curve.green[static_cast<std::size_t>(valley)]);
  return 1.0 - low / std::min(a.height, b.height);
}

/// Takes away the lower of two tops that do not part as `needed` by their distance in spacings,
/// the worst first, until all do.
template <typename Needed>
void mergeTops(const RowProfile& curve, double distance, const Needed& needed,
               std::vector<Top>& tops) {
  while (tops.size() > 1) {
    double worst = 0.0;
    std::size_t at = tops.size();
    for (std::size_t i = 0; i + 1 < tops.size(); ++i) {
      const double apart = (tops[i + 1].index - tops[i].index) * curve.step / distance;
      const double lacking = needed(apart) - parting(curve, tops[i], tops[i + 1]);
      if (lacking > worst) {
        worst = lacking;
        at = i;
      }
    }
    if (at == tops.size()) return;
    const bool first = tops[at].height < tops[at + 1].height;
    tops.erase(tops.begin() + static_cast<std::ptrdiff_t>(first ? at : at + 1));
  }
}

/// Fills in what is green from sample `from` to before `to`.
void measure(const RowProfile& profile, const RowProfile& curve, int from, int to, Piece& piece) {
  double sum = 0.0;
  double along = 0.0;
  double leafy = 0.0;
  double lean = 0.0;
  int green = 0;
  for (int i = from; i < to; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double value = std::max(0.0, curve.green[k]);
    sum += value;
    along += value * profile.along(i);
    leafy += profile.leafy[k];
    lean += profile.lean[k];
    piece.area += value * profile.step;
    if (curve.green[k] > kEdge * piece.height) ++green;
  }
  piece.from = from * profile.step;
  piece.to = to * profile.step;
  piece.middle = sum > 0.0 ? along / sum : piece.top;
  piece.aside = leafy > 0.0 ? lean / leafy : 0.0;
  piece.length = green * profile.step;
}

/// A piece as long as two plants has no valley, but may be two: parts of equal green, that the
/// rhythm of the row may part. What is longer than `kMostParts` of them stays one.
void addParts(const RowProfile& profile, const RowProfile& curve, int from, int to,
              const Piece& whole, double distance, std::vector<Piece>& pieces) {
  const double longest = whole.length / distance;
  const int parts = longest > kLongPiece ? static_cast<int>(std::lround(longest / kPartLength)) : 1;
  if (parts < 2 || parts > kMostParts) {
    pieces.push_back(whole);
    return;
  }
  double all = 0.0;
  for (int i = from; i < to; ++i) all += std::max(0.0, curve.green[static_cast<std::size_t>(i)]);
  double sum = 0.0;
  int begin = from;
  for (int part = 1; part <= parts; ++part) {
    int end = begin;
    while (end < to && (sum < all * part / parts || end == begin)) {
      sum += std::max(0.0, curve.green[static_cast<std::size_t>(end)]);
      ++end;
    }
    if (part == parts) end = to;
    if (end == begin) continue;
    Piece piece = whole;
    piece.area = 0.0;
    measure(profile, curve, begin, end, piece);
    piece.top = piece.middle;
    piece.parted = part == parts ? whole.parted : 0.0;
    pieces.push_back(piece);
    begin = end;
  }
}

}  // namespace

double usualTop(const std::vector<RowProfile>& rows, double distance) {
  constexpr double kClearOfNoise = 1.5;
  std::vector<double> heights;
  for (const RowProfile& row : rows) {
    const RowProfile curve = sharpened(row, kSmoothing * distance, kSharpening);
    std::vector<Top> tops = topsOf(curve);
    std::erase_if(tops, [&](const Top& top) { return top.height < kClearOfNoise * curve.noise; });
    mergeTops(curve, distance, depthNeeded, tops);
    for (const Top& top : tops) heights.push_back(top.height);
  }
  return heights.empty() ? 0.0 : median(heights);
}

std::vector<Piece> piecesOf(const RowProfile& profile, double distance, double usual) {
  const RowProfile curve = sharpened(profile, kFineSmoothing * distance, kFineSharpening);
  const double least = std::max(kNoiseTop * curve.noise, kLeastTop * usual);
  std::vector<Top> tops = topsOf(curve);
  std::erase_if(tops, [&](const Top& top) { return top.height < least; });
  const auto needed = [](double apart) { return apart < kNearest ? 2.0 : kLeastParted; };
  mergeTops(curve, distance, needed, tops);
  std::vector<Piece> pieces;
  int from = 0;
  for (std::size_t i = 0; i < tops.size(); ++i) {
    const bool last = i + 1 == tops.size();
    const int to = last ? curve.size() : lowestBetween(curve, tops[i].index, tops[i + 1].index);
    Piece piece;
    piece.top = curve.along(tops[i].index);
    piece.height = tops[i].height;
    piece.parted = last ? 1.0 : parting(curve, tops[i], tops[i + 1]);
    measure(profile, curve, from, to, piece);
    addParts(profile, curve, from, to, piece, distance, pieces);
    from = to;
  }
  return pieces;
}

}  // namespace agricolmap::crop
