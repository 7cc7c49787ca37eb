// A two-dimensional complex FFT whose inner loops run over whole rows, so that the compiler's
// vector instructions do the work.
//
// Why not a library: FFTW is GPL and would bind our Apache-licensed binaries, and the permissive
// one in Debian (KissFFT) is built without vector instructions; the search's time is FFTs.
#pragma once

#include <cstddef>
#include <vector>

namespace agricolmap::correlation {

/// A complex raster as two arrays. After `Fft2::forward` it holds the spectrum, transposed.
struct ComplexRaster {
  std::vector<float> re;
  std::vector<float> im;
  explicit ComplexRaster(std::size_t size = 0) : re(size, 0.0F), im(size, 0.0F) {}
  std::size_t size() const { return re.size(); }
};

/// One axis of length n, over `batch` interleaved sequences (element k of sequence b at
/// k·batch + b). Stockham's self-sorting scheme with radices 4, 3, 5 and 2.
class BatchFft {
 public:
  explicit BatchFft(int length);
  /// exp(−2πi…) when forward, exp(+2πi…) otherwise; not scaled. `data` and `scratch` hold at least
  /// length · batch elements, and the result may be in either's former memory.
  /// `threads`: spread over the cores, to the same bits; else in the caller's thread.
  void transform(ComplexRaster& data, ComplexRaster& scratch, int batch, bool forward,
                 bool threads = false) const;

 private:
  struct Pass {
    int radix;
    int remaining;                ///< length of the sub-sequences before this pass
    int stride;                   ///< how many of them are interleaved
    std::vector<float> cos, sin;  ///< twiddles [p · radix + j], p < remaining / radix
  };
  std::vector<Pass> passes_;
};

/// Two axes, rows × cols, both products of 2, 3 and 5.
class Fft2 {
 public:
  Fft2(int rows, int cols);
  /// The smallest product of 2, 3 and 5 that is at least `n`.
  static int goodSize(int n);

  int rows() const { return rows_; }
  int cols() const { return cols_; }
  std::size_t size() const { return static_cast<std::size_t>(rows_) * cols_; }
  /// rows × cols → spectrum stored cols × rows. Not scaled.
  void forward(ComplexRaster& data, ComplexRaster& scratch, bool threads = false) const;
  /// The same for data that is zero but for a small piece: `piece` is rows × width, row-major, and
  /// stands in the columns first_col, first_col + 1, … (modulo cols). Costs little more than half.
  /// `piece` and `piece_scratch` are overwritten.
  void forwardPiece(ComplexRaster& piece, ComplexRaster& piece_scratch, int width, int first_col,
                    ComplexRaster& spectrum, ComplexRaster& scratch) const;
  /// Spectrum stored cols × rows → rows × cols, scaled by 1/(rows·cols).
  void inverse(ComplexRaster& data, ComplexRaster& scratch, bool threads = false) const;

 private:
  int rows_;
  int cols_;
  BatchFft along_rows_;  ///< over the row index
  BatchFft along_cols_;  ///< over the column index of the transposed data
};

}  // namespace agricolmap::correlation
