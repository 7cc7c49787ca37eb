#include "experiments/runner/outcome_file.hpp"

#include <fmt/format.h>

#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "agricolmap/core/error.hpp"

namespace agricolmap::experiments {
namespace {

using Json = nlohmann::ordered_json;

/// JSON has no NaN: null stands for it.
double numberFrom(const Json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

/// Column by column.
template <typename Matrix>
Json matrixJson(const Matrix& matrix) {
  return std::vector<double>(matrix.data(), matrix.data() + matrix.size());
}
template <typename Matrix>
void matrixFrom(const Json& values, Matrix& matrix) {
  for (Eigen::Index i = 0; i < matrix.size(); ++i) {
    matrix.data()[i] = numberFrom(values.at(static_cast<std::size_t>(i)));
  }
}

Json statedJson(const StatedError& stated) {
  return {{"covariance", matrixJson(stated.pose.covariance)},
          {"centre", matrixJson(stated.pose.centre)},
          {"axes", matrixJson(stated.pose.axes)},
          {"height_deviation", stated.pose.height_deviation},
          {"levelled_from_fixed", matrixJson(stated.levelled_from_fixed.matrix())}};
}

StatedError statedFrom(const Json& json) {
  StatedError stated;
  matrixFrom(json.at("covariance"), stated.pose.covariance);
  matrixFrom(json.at("centre"), stated.pose.centre);
  matrixFrom(json.at("axes"), stated.pose.axes);
  stated.pose.height_deviation = numberFrom(json.at("height_deviation"));
  matrixFrom(json.at("levelled_from_fixed"), stated.levelled_from_fixed.matrix());
  return stated;
}

Answer answerFrom(const Json& json) {
  Answer answer;
  MethodOutcome& outcome = answer.outcome;
  const auto status = json.at("status").get<std::string>();
  outcome.accepted = status == "accepted";
  outcome.ambiguous = status == "ambiguous";
  outcome.why = json.at("why").get<std::string>();
  if (const Json& rows = json.at("fixed_from_moving"); !rows.is_null()) {
    outcome.fixed_from_moving.emplace();
    matrixFrom(rows, outcome.fixed_from_moving->matrix());
  }
  for (const auto& [stage, seconds] : json.at("stages_s").items()) {
    outcome.times.add(stage, seconds.get<double>());
  }
  for (const auto& [name, value] : json.at("facts").items()) {
    outcome.facts.emplace_back(name, numberFrom(value));
  }
  if (json.contains("stated_error")) outcome.stated = statedFrom(json["stated_error"]);
  answer.run_s = json.at("run_s").get<double>();
  answer.read_s = json.at("read_s").get<double>();
  answer.idle_mib = json.at("idle_memory_mib").get<double>();
  answer.peak_mib = json.at("peak_memory_mib").get<double>();
  return answer;
}

}  // namespace

std::string statusOf(const MethodOutcome& outcome) {
  if (!outcome.fixed_from_moving) return "failed";
  if (outcome.ambiguous) return "ambiguous";
  return outcome.accepted ? "accepted" : "rejected";
}

std::string toJson(const Answer& answer, const std::string& method) {
  const MethodOutcome& outcome = answer.outcome;
  Json json = {{"method", method},
               {"status", statusOf(outcome)},
               {"why", outcome.why},
               {"fixed_from_moving", nullptr},
               {"read_s", answer.read_s},
               {"run_s", answer.run_s},
               {"idle_memory_mib", answer.idle_mib},
               {"peak_memory_mib", answer.peak_mib},
               {"stages_s", Json::object()},
               {"facts", Json::object()}};
  if (outcome.fixed_from_moving) {
    json["fixed_from_moving"] = matrixJson(outcome.fixed_from_moving->matrix());
  }
  for (const auto& [stage, seconds] : outcome.times.stages()) json["stages_s"][stage] = seconds;
  for (const auto& [name, value] : outcome.facts) json["facts"][name] = value;
  if (outcome.stated) json["stated_error"] = statedJson(*outcome.stated);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

Answer readAnswer(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw InputError(fmt::format("{}: cannot be read", path.string()));
  try {
    return answerFrom(Json::parse(file));
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("{}: is no answer of a method: {}", path.string(), error.what()));
  }
}

}  // namespace agricolmap::experiments
