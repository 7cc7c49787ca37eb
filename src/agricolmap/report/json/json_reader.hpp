// Reading our own JSON files on the assumption that they are damaged.
#pragma once

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "agricolmap/core/error.hpp"

namespace agricolmap::report {

/// Reads values by their place in the document, which messages name.
class JsonReader {
 public:
  JsonReader(const nlohmann::json& json, std::string name, std::string place = "")
      : json_(json), name_(std::move(name)), place_(std::move(place)) {}

  template <typename... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
    throw InputError(fmt::format("{}: damaged: {}{}{}", name_, place_, place_.empty() ? "" : " ",
                                 fmt::format(format, std::forward<Args>(args)...)));
  }
  bool isNull() const { return json_.is_null(); }
  JsonReader at(const std::string& key) const {
    const std::string place = place_.empty() ? key : place_ + "." + key;
    if (!json_.is_object() || !json_.contains(key)) {
      throw InputError(fmt::format("{}: damaged: {} is missing", name_, place));
    }
    return {json_.at(key), name_, place};
  }
  bool has(const std::string& key) const { return json_.is_object() && json_.contains(key); }
  std::vector<JsonReader> items() const {
    if (!json_.is_array()) fail("is no list");
    std::vector<JsonReader> all;
    for (std::size_t i = 0; i < json_.size(); ++i) {
      all.emplace_back(json_[i], name_, fmt::format("{}[{}]", place_, i));
    }
    return all;
  }
  double number() const {
    if (!json_.is_number()) fail("is no number");
    return json_.get<double>();
  }
  /// `otherwise` where it is null: JSON has no NaN and no infinity.
  double numberOr(double otherwise) const { return isNull() ? otherwise : number(); }
  bool flag() const {
    if (!json_.is_boolean()) fail("is neither true nor false");
    return json_.get<bool>();
  }
  std::string text() const {
    if (!json_.is_string()) fail("is no text");
    return json_.get<std::string>();
  }
  int integer() const {
    if (!json_.is_number_integer()) fail("is no whole number");
    return json_.get<int>();
  }
  template <int kSize>
  Eigen::Matrix<double, kSize, 1> vector() const {
    const auto all = items();
    if (all.size() != kSize) fail("has {} numbers, not {}", all.size(), kSize);
    Eigen::Matrix<double, kSize, 1> vector;
    for (int i = 0; i < kSize; ++i) vector[i] = all[static_cast<std::size_t>(i)].number();
    return vector;
  }
  template <int kRows, int kCols>
  Eigen::Matrix<double, kRows, kCols> matrix() const {
    const auto all = items();
    if (all.size() != kRows) fail("has {} rows, not {}", all.size(), kRows);
    Eigen::Matrix<double, kRows, kCols> matrix;
    for (int r = 0; r < kRows; ++r) {
      matrix.row(r) = all[static_cast<std::size_t>(r)].template vector<kCols>().transpose();
    }
    return matrix;
  }
  Eigen::Affine3d affine() const {
    const Eigen::Matrix4d whole = matrix<4, 4>();
    if (whole.row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)) fail("does not end in 0 0 0 1");
    Eigen::Affine3d affine;
    affine.matrix() = whole;
    const double volume = affine.linear().determinant();
    if (!(volume > 1e-9 && volume < 1e9)) fail("is no way from one field to another");
    return affine;
  }

 private:
  const nlohmann::json& json_;
  std::string name_;
  std::string place_;
};

/// One of our kinds of documents.
struct DocumentKind {
  std::string format;  ///< its "format"
  std::string words;   ///< "shared map", for messages
  std::string remedy;  ///< what to do where one is damaged
};

/// The document in a file of ours. Throws InputError when it is no JSON, of another kind, or its
/// "format_version" is not 1.
nlohmann::json readDocument(const std::filesystem::path& path, const DocumentKind& kind);

}  // namespace agricolmap::report
