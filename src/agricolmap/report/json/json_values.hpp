// Numbers, vectors and texts as JSON has them.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "agricolmap/report/json/utf8.hpp"

namespace agricolmap::report {

/// Null stands for numbers that JSON lacks.
inline nlohmann::ordered_json number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

template <typename Derived>
nlohmann::ordered_json vectorJson(const Eigen::MatrixBase<Derived>& vector) {
  auto json = nlohmann::ordered_json::array();
  for (Eigen::Index i = 0; i < vector.size(); ++i) json.push_back(number(vector(i)));
  return json;
}

/// Row-major, nested.
template <typename Derived>
nlohmann::ordered_json matrixJson(const Eigen::MatrixBase<Derived>& matrix) {
  auto json = nlohmann::ordered_json::array();
  for (Eigen::Index r = 0; r < matrix.rows(); ++r) json.push_back(vectorJson(matrix.row(r)));
  return json;
}

inline nlohmann::ordered_json stringsJson(const std::vector<std::string>& strings) {
  auto json = nlohmann::ordered_json::array();
  for (const std::string& text : strings) json.push_back(validUtf8(text));
  return json;
}

}  // namespace agricolmap::report
