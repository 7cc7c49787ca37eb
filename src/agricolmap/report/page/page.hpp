// A page of its own from what the programs read: one file that works by itself.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace agricolmap::report {

/// What a page is made from. web/main.js tells by the report's `format` what it is of.
struct PageContent {
  nlohmann::ordered_json report;  ///< registration.json, or another file of the program
  nlohmann::ordered_json facts;   ///< what the page says beside it
  nlohmann::ordered_json scene;   ///< maps and points; null: without
};

/// The whole page, UTF-8. `title`: of the window; `plain_words`: HTML that is read where scripts do
/// not run.
std::string pageOf(const PageContent& content, const std::string& title,
                   const std::string& plain_words);

}  // namespace agricolmap::report
