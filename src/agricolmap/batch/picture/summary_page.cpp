#include "agricolmap/batch/picture/summary_page.hpp"

#include "agricolmap/batch/summary.hpp"
#include "agricolmap/report/page/page.hpp"
#include "agricolmap/report/page/page_text.hpp"

namespace agricolmap::batch {

std::string summaryPage(std::span<const Record> records, const Manifest& manifest, double seconds) {
  const std::string counts = toText(countsOf(records));
  report::PageContent content;
  content.report = summaryJson(records, manifest, seconds);
  std::string words = "<p>" + counts + "</p><ul>";
  for (const Record& record : records) {
    words += "<li>" + report::htmlText(record.id + ": " + record.status) + "</li>";
  }
  return report::pageOf(content, counts + ": " + manifest.file.string(), words + "</ul>");
}

}  // namespace agricolmap::batch
