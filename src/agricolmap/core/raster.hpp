// Rasters and where they lie on the ground.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace agricolmap {

/// A row-major array of `rows × cols` values. Row 0 is the southernmost (smallest y).
template <typename T>
class Raster {
 public:
  Raster() = default;
  Raster(int rows, int cols, T fill = T{})  // NOLINT(performance-unnecessary-value-param): numbers
      : rows_(rows), cols_(cols), data_(static_cast<std::size_t>(rows) * cols, fill) {}

  int rows() const { return rows_; }
  int cols() const { return cols_; }
  std::size_t size() const { return data_.size(); }
  bool empty() const { return data_.empty(); }
  bool contains(int row, int col) const {
    return row >= 0 && col >= 0 && row < rows_ && col < cols_;
  }
  std::size_t index(int row, int col) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(cols_) +
           static_cast<std::size_t>(col);
  }
  T& operator()(int row, int col) { return data_[index(row, col)]; }
  const T& operator()(int row, int col) const { return data_[index(row, col)]; }
  T& operator[](std::size_t i) { return data_[i]; }
  const T& operator[](std::size_t i) const { return data_[i]; }
  T* row(int r) { return data_.data() + index(r, 0); }
  const T* row(int r) const { return data_.data() + index(r, 0); }
  T* data() { return data_.data(); }
  const T* data() const { return data_.data(); }
  auto begin() { return data_.begin(); }
  auto end() { return data_.end(); }
  auto begin() const { return data_.begin(); }
  auto end() const { return data_.end(); }

 private:
  int rows_ = 0;
  int cols_ = 0;
  std::vector<T> data_;
};

/// Where a raster lies: metres of the levelled frame ↔ cells. Cell (r, c) covers
/// [corner.x + c·cell, corner.x + (c+1)·cell) × [corner.y + r·cell, …).
struct GridFrame {
  Eigen::Vector2d corner = Eigen::Vector2d::Zero();  ///< south-west corner [m]
  double cell = 0.0;                                 ///< side of a cell [m]
  int rows = 0;
  int cols = 0;

  /// Centre of cell (row, col) [m].
  Eigen::Vector2d centre(double row, double col) const {
    return corner + cell * Eigen::Vector2d(col + 0.5, row + 0.5);
  }
  /// Continuous (col, row) of a point, 0 at the centre of cell 0.
  Eigen::Vector2d cellOf(const Eigen::Vector2d& point) const {
    return (point - corner) / cell - Eigen::Vector2d::Constant(0.5);
  }
};

}  // namespace agricolmap
