// Pictures as tests look at them: a folder for each test, and PNGs read by another reader.
#pragma once

#include <cairo.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <functional>
#include <memory>

namespace agricolmap::testing {

/// A folder of its own for each test, removed afterwards.
class PictureTest : public ::testing::Test {
 protected:
  void SetUp() override {
    dir_ = std::filesystem::temp_directory_path() /
           ("agricolmap_pictures_" + std::to_string(getpid()) + "_" +
            ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(dir_);
  }
  void TearDown() override { std::filesystem::remove_all(dir_); }

  std::filesystem::path dir_;
};

/// A PNG as cairo, an independent reader, sees it.
class Picture {
 public:
  explicit Picture(const std::filesystem::path& path)
      : surface_(cairo_image_surface_create_from_png(path.c_str()), cairo_surface_destroy) {}
  bool ok() const { return cairo_surface_status(surface_.get()) == CAIRO_STATUS_SUCCESS; }
  int width() const { return cairo_image_surface_get_width(surface_.get()); }
  int height() const { return cairo_image_surface_get_height(surface_.get()); }
  std::uint32_t pixel(int x, int y) const {
    std::uint32_t value = 0;
    std::memcpy(
        &value,
        cairo_image_surface_get_data(surface_.get()) +
            static_cast<std::ptrdiff_t>(y) * cairo_image_surface_get_stride(surface_.get()) +
            std::ptrdiff_t{4} * x,
        4);
    return value & 0xFFFFFFU;
  }
  double share(const std::function<bool(int r, int g, int b)>& is) const {
    double count = 0.0;
    for (int y = 0; y < height(); ++y) {
      for (int x = 0; x < width(); ++x) {
        const std::uint32_t p = pixel(x, y);
        if (is((p >> 16) & 255, (p >> 8) & 255, p & 255)) count += 1.0;
      }
    }
    return count / (static_cast<double>(width()) * height());
  }

 private:
  std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)> surface_;
};

}  // namespace agricolmap::testing
