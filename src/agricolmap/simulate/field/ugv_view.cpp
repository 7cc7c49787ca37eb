#include <algorithm>
#include <array>
#include <cmath>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/simulate/field/colour_response.hpp"
#include "agricolmap/simulate/field/views.hpp"

namespace agricolmap::simulate {

namespace {

constexpr int kCameras = 5;  // positions from which a place is looked at

/// The strip seen by a camera that drives along the canvas's x axis and looks ahead.
class StripSensor {
 public:
  StripSensor(const Canvas& canvas, const UgvOptions& options, std::uint64_t seed)
      : canvas_(&canvas),
        options_(&options),
        seed_(seed),
        cell_(static_cast<float>(canvas.window.cell)),
        x0_(0.5 * (canvas.window.width() - options.length)),
        y_middle_(0.5 * canvas.window.height()),
        colour_(options.colour, meanLight(canvas), seed),
        smooth_(canvas.window.rows, canvas.window.cols) {
    parallelFor(
        static_cast<std::size_t>(canvas.window.rows),
        [&](std::size_t r) {
          const Cell* cells = canvas.cells.row(static_cast<int>(r));
          float* z = smooth_.row(static_cast<int>(r));
          for (int c = 0; c < canvas.window.cols; ++c) z[c] = cells[c].z;
        },
        16);
    fillCeiling();
    blurRaster(smooth_, options.smoothing / canvas.window.cell);
    fillCameraHeights();
    fillPoseShifts();
  }

  int rows() const { return static_cast<int>(std::ceil(options_->width / options_->spacing)); }

  /// The points of one line along the strip.
  FieldPoints row(int r) const {
    FieldPoints points;
    Random random = Random::stream(seed_ ^ 0x6A09, static_cast<std::uint64_t>(r));
    const int cols = static_cast<int>(std::ceil(options_->length / options_->spacing));
    points.xyz.reserve(static_cast<std::size_t>(cols));
    points.rgb.reserve(static_cast<std::size_t>(cols));
    for (int c = 0; c < cols; ++c) addSample(c, r, random, points);
    return points;
  }

 private:
  static double meanLight(const Canvas& canvas) {
    const int rows = canvas.window.rows;
    const int cols = canvas.window.cols;
    const double sum = parallelSum(
        static_cast<std::size_t>(rows), 32, 0.0, [&](std::size_t begin, std::size_t end) {
          double part = 0.0;
          for (std::size_t r = begin; r < end; ++r) {
            for (int c = 0; c < cols; ++c) {
              part += static_cast<double>(canvas.radiance(static_cast<int>(r), c)[1]);
            }
          }
          return part;
        });
    return sum / (static_cast<double>(rows) * cols);
  }

  /// Highest surface per block of columns, so that rays stop once nothing can hide the camera.
  void fillCeiling() {
    const int blocks = smooth_.cols() / kBlock + 1;
    ceiling_.assign(static_cast<std::size_t>(blocks), -1e9F);
    for (int r = 0; r < smooth_.rows(); ++r) {
      for (int c = 0; c < smooth_.cols(); ++c) {
        float& top = ceiling_[static_cast<std::size_t>(c / kBlock)];
        top = std::max(top, smooth_(r, c));
      }
    }
    // A ray goes back by at most look_far.
    const int reach = static_cast<int>(options_->look_far / canvas_->window.cell) / kBlock + 1;
    std::vector<float> widest(ceiling_);
    for (int b = 0; b < blocks; ++b) {
      for (int k = std::max(0, b - reach); k <= b; ++k) {
        widest[static_cast<std::size_t>(b)] =
            std::max(widest[static_cast<std::size_t>(b)], ceiling_[static_cast<std::size_t>(k)]);
      }
    }
    ceiling_ = std::move(widest);
  }

  /// The robot rides on the soil: camera height above the field's zero by column.
  void fillCameraHeights() {
    const int middle = canvas_->window.rows / 2;
    camera_z_.resize(static_cast<std::size_t>(canvas_->window.cols));
    float carried = canvas_->ground(middle, 0);
    for (int c = 0; c < canvas_->window.cols; ++c) {
      carried += 0.02F * (canvas_->ground(middle, c) - carried);
      camera_z_[static_cast<std::size_t>(c)] =
          carried + static_cast<float>(options_->camera_height);
    }
  }

  /// Every camera position is a little off: its points shift together.
  void fillPoseShifts() {
    const auto poses =
        static_cast<std::uint64_t>(canvas_->window.width() / static_cast<double>(kPoseDistance)) +
        2;
    const double sigma = options_->pose_noise;
    for (std::uint64_t pose = 0; pose < poses; ++pose) {
      Random random = Random::stream(seed_ ^ 0x905E, pose);
      pose_shifts_.emplace_back(static_cast<float>(random.normal(sigma)),
                                static_cast<float>(random.normal(sigma)),
                                static_cast<float>(random.normal(0.7 * sigma)));
    }
  }
  const Eigen::Vector3f& poseShift(float camera_x) const {
    const auto pose = static_cast<std::size_t>(std::max(0.0F, camera_x / kPoseDistance));
    return pose_shifts_[std::min(pose, pose_shifts_.size() - 1)];
  }

  struct Ray {
    float back = 0.0F;          ///< distance of the camera behind the surface, along the strip [m]
    Eigen::Vector3f direction;  ///< unit, from the surface to the camera
    float slope = 0.0F;         ///< rise per horizontal metre
  };

  Ray rayTo(float x, float y, float z, int camera) const {
    const double share = (camera + 0.5) / kCameras;
    const auto back = static_cast<float>(options_->look_near +
                                         share * (options_->look_far - options_->look_near));
    const float camera_x = x - back;
    const int c = std::clamp(static_cast<int>(camera_x / cell_), 0, canvas_->window.cols - 1);
    const Eigen::Vector3f to(-back, static_cast<float>(y_middle_) - y,
                             camera_z_[static_cast<std::size_t>(c)] - z);
    return {back, to.normalized(), to.z() / to.head<2>().norm()};
  }

  bool hidden(float x, float y, float z, const Ray& ray) const {
    const float top = ceiling_[static_cast<std::size_t>(
        std::clamp(static_cast<int>(x / cell_), 0, canvas_->window.cols - 1) / kBlock)];
    constexpr float kStep = 2.0F;  // in cells
    const Eigen::Vector2f direction = ray.direction.head<2>().normalized();
    const float rise = ray.slope * kStep * cell_;
    if (rise <= 0.0F) return true;  // the plant is taller than the camera
    float col = x / cell_ - 0.5F;
    float row = y / cell_ - 0.5F;
    float height = z + 0.004F;
    while (height < top) {
      col += kStep * direction.x();
      row += kStep * direction.y();
      height += rise;
      const int c = static_cast<int>(col + 0.5F);
      const int r = static_cast<int>(row + 0.5F);
      if (c < 0 || r < 0 || c >= canvas_->window.cols || r >= canvas_->window.rows) return false;
      const float over = canvas_->cells(r, c).z - height;
      if (over <= 0.0F) continue;
      // Deep under a leaf the ray passes between the stalks; the soil stops every ray.
      if (over < canvas_->leaf_depth || height < canvas_->ground(r, c)) return true;
    }
    return false;
  }

  void addSample(int c, int r, Random& random, FieldPoints& points) const {
    const double spacing = options_->spacing;
    const double along = (c + random.uniform()) * spacing;
    const double aside = (r + random.uniform()) * spacing - 0.5 * options_->width;
    // Farther from the path the same pixels cover more ground.
    const double edge = 2.0 * std::abs(aside) / options_->width;
    const double kept = 1.0 - (1.0 - options_->edge_density) * edge * edge;
    if (along > options_->length || 2.0 * std::abs(aside) > options_->width) return;
    if (!random.chance(kept)) return;
    const auto x = static_cast<float>(x0_ + along);
    const auto y = static_cast<float>(y_middle_ + aside);
    const int col = std::clamp(static_cast<int>(x / cell_), 0, canvas_->window.cols - 1);
    const int row = std::clamp(static_cast<int>(y / cell_), 0, canvas_->window.rows - 1);
    if (!canvas_->isPresent(row, col)) return;
    const float top = canvas_->cells(row, col).z;
    const int first = static_cast<int>(random.below(kCameras));
    Ray ray;
    bool seen = false;
    for (int k = 0; k < kCameras && !seen; ++k) {
      ray = rayTo(x, y, top, (first + k) % kCameras);
      seen = !hidden(x, y, top, ray);
    }
    if (!seen) return;
    const Eigen::Vector3f& shift = poseShift(x - ray.back);
    float z = sampleRaster(smooth_, x / cell_ - 0.5F, y / cell_ - 0.5F);
    Eigen::Vector3f point(static_cast<float>(along), static_cast<float>(aside), z);
    // Depth errors lie along the ray; a wider spread at the strip's edges.
    const auto depth = static_cast<float>(random.normal(options_->noise * (1.0 + edge * edge)));
    point += depth * ray.direction + shift;
    if (random.chance(options_->outliers)) {
      point += Eigen::Vector3f(static_cast<float>(random.normal(0.03)),
                               static_cast<float>(random.normal(0.03)),
                               static_cast<float>(random.uniform(-0.08, 0.35)));
    }
    push(point, col, row, 1.0F, random, points);
    addSide(x, y, col, row, random, points);
  }

  /// Sides of plants that face the camera: between the top of this cell and the surface just
  /// before it, which the drone never sees.
  void addSide(float x, float y, int col, int row, Random& random, FieldPoints& points) const {
    const int before = std::max(0, col - 2);
    const float low = canvas_->cells(row, before).z;
    const float high = canvas_->cells(row, col).z;
    if (high - low < 0.02F || !random.chance(options_->side_points)) return;
    const auto z =
        static_cast<float>(random.uniform(static_cast<double>(low), static_cast<double>(high)));
    const Eigen::Vector3f point(x - static_cast<float>(x0_) - cell_,
                                y - static_cast<float>(y_middle_), z);
    push(point, col, row, 0.7F, random, points);
  }

  void push(const Eigen::Vector3f& point, int col, int row, float dim, Random& random,
            FieldPoints& points) const {
    std::array<float, 3> radiance = canvas_->radiance(row, col);
    for (float& channel : radiance) channel *= dim;
    points.xyz.push_back(point);
    points.rgb.push_back(colour_(
        radiance, {static_cast<double>(point.x()), static_cast<double>(point.y())}, random));
  }

  static constexpr int kBlock = 32;
  static constexpr float kPoseDistance = 0.25F;  // between camera positions [m]
  const Canvas* canvas_;
  const UgvOptions* options_;
  std::uint64_t seed_;
  float cell_;
  double x0_;        ///< beginning of the strip in the canvas [m]
  double y_middle_;  ///< middle line of the strip in the canvas [m]
  ColourResponse colour_;
  Raster<float> smooth_;
  std::vector<float> ceiling_;
  std::vector<float> camera_z_;
  std::vector<Eigen::Vector3f> pose_shifts_;
};

}  // namespace

FieldPoints senseFromGround(const Canvas& canvas, const UgvOptions& options, std::uint64_t seed) {
  const StripSensor sensor(canvas, options, seed);
  std::vector<FieldPoints> rows(static_cast<std::size_t>(sensor.rows()));
  parallelFor(
      rows.size(), [&](std::size_t r) { rows[r] = sensor.row(static_cast<int>(r)); }, 4);
  return joinPoints(rows);
}

}  // namespace agricolmap::simulate
