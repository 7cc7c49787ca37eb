#include "agricolmap/report/page/registration_page.hpp"

#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/report/page/page_assets.hpp"
#include "agricolmap/report/page/page_facts.hpp"
#include "agricolmap/report/page/page_text.hpp"

namespace agricolmap::report {
namespace {

using Json = nlohmann::ordered_json;

/// What is read where scripts do not run.
std::string plainWords(const PageContent& content) {
  std::string words =
      "<p>" + htmlText(content.facts.at("headline").get<std::string>()) + "</p><ul>";
  for (const char* list : {"reasons", "remedies"}) {
    for (const Json& line : content.report.at(list)) {
      words += "<li>" + htmlText(line.get<std::string>()) + "</li>";
    }
  }
  return words + "</ul>";
}

}  // namespace

Json pageFacts(const CloudOrigins& origins, const pipeline::Registration& registration,
               const pipeline::RegistrationOptions& options, const std::string& preset,
               const std::string& scene_missing) {
  Json json;
  json["headline"] = headline(registration.verdict);
  json["strip"] = stripFacts(registration);
  json["blocks"] = blocksFacts(registration);
  json["rigid"] = rigidFacts(origins, registration);
  json["options"] = optionsFacts(options, preset);
  json["scene_missing"] = scene_missing;
  json["with_3d"] = !pageScript3d().empty();
  return json;
}

std::string registrationPage(const PageContent& content) {
  const Json& report = content.report;
  const std::string name = report.at("moving").at("path").get<std::string>();
  return pageOf(content, report.at("status").get<std::string>() + ": " + name, plainWords(content));
}

void writeRegistrationPage(const io::OutputPath& path, const PageContent& content) {
  io::writeText(path, registrationPage(content));
}

}  // namespace agricolmap::report
