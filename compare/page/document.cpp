#include "page/document.hpp"

#include <fmt/format.h>

#include "svg_plot.hpp"

namespace agricolmap::compare {
namespace {

using campaign::escapeXml;

constexpr const char* kCss = R"(<style>
:root { --ground: #ffffff; --ink: #1f2328; --soft: #59636e; --rule: #d1d9e0; --shade: #f6f8fa; }
@media (prefers-color-scheme: dark) {
  :root { --ground: #0d1117; --ink: #e6edf3; --soft: #9da7b3; --rule: #3d444d; --shade: #161b22; }
}
:root { color-scheme: light dark; }
body { background: var(--ground); color: var(--ink); margin: 0 auto; padding: 1rem;
  max-width: 72rem; font: 16px/1.5 system-ui, "DejaVu Sans", sans-serif; }
h1 { line-height: 1.2; margin: 0.5rem 0; }
h2 { margin: 2.2rem 0 0.6rem; border-bottom: 1px solid var(--rule); padding-bottom: 0.2rem; }
p { max-width: 46rem; }
.soft { color: var(--soft); font-size: 0.85rem; overflow-wrap: anywhere; }
.wide { overflow-x: auto; margin: 0 0 1.2rem; }
.wide svg { display: block; min-width: 42rem; width: 100%; max-width: 60rem; height: auto; }
table { border-collapse: collapse; font-size: 0.85rem; font-variant-numeric: tabular-nums; }
th, td { padding: 0.3rem 0.6rem; border-bottom: 1px solid var(--rule); text-align: left;
  vertical-align: top; }
th { white-space: nowrap; }
td { min-width: 6.5rem; max-width: 13rem; }
thead th { background: var(--shade); }
tbody th { position: sticky; left: 0; background: var(--ground); font-weight: 600; }
@media (max-width: 40rem) { tbody th { white-space: normal; overflow-wrap: anywhere; min-width: 5rem;
  max-width: 6.5rem; } }
.paper { display: block; color: var(--soft); font-size: 0.75rem; }
.caption { font-weight: 600; margin: 1rem 0 0.4rem; }
</style>
)";

std::string cellHtml(const TableCell& cell) {
  std::string text = escapeXml(cell.ours);
  if (!cell.paper.empty()) {
    text += fmt::format("<span class=\"paper\">paper, real data: {}</span>", escapeXml(cell.paper));
  }
  return text;
}

struct HtmlBlock {
  std::string operator()(const Heading& heading) const {
    return fmt::format("<h2>{}</h2>\n", escapeXml(heading.text));
  }
  std::string operator()(const Paragraph& paragraph) const {
    return fmt::format("<p>{}</p>\n", escapeXml(paragraph.text));
  }
  std::string operator()(const Table& table) const {
    std::string html = fmt::format("<p class=\"caption\">{}</p>\n", escapeXml(table.caption));
    html += "<div class=\"wide\"><table><thead><tr>";
    for (const std::string& name : table.head) html += fmt::format("<th>{}</th>", escapeXml(name));
    html += "</tr></thead><tbody>\n";
    for (const std::vector<TableCell>& row : table.rows) {
      html += "<tr>";
      for (std::size_t i = 0; i < row.size(); ++i) {
        html += fmt::format("<{0}>{1}</{0}>", i == 0 ? "th" : "td", cellHtml(row[i]));
      }
      html += "</tr>\n";
    }
    return html + "</tbody></table></div>\n";
  }
  std::string operator()(const Figure& figure) const {
    return fmt::format("<p class=\"caption\">{}</p>\n<div class=\"wide\">{}</div>\n",
                       escapeXml(figure.caption), figure.svg);
  }
};

/// Without what parts the cells of a table.
std::string cellMarkdown(const TableCell& cell) {
  std::string text = cell.ours.empty() ? "–" : cell.ours;
  if (!cell.paper.empty()) text += fmt::format("<br>paper, real data: {}", cell.paper);
  for (char& c : text) {
    if (c == '|') c = '/';
  }
  return text;
}

struct MarkdownBlock {
  std::string images;
  std::string operator()(const Heading& heading) const {
    return fmt::format("## {}\n\n", heading.text);
  }
  std::string operator()(const Paragraph& paragraph) const { return paragraph.text + "\n\n"; }
  std::string operator()(const Table& table) const {
    std::string text = fmt::format("**{}**\n\n|", table.caption);
    std::string rule = "|";
    for (const std::string& name : table.head) {
      text += fmt::format(" {} |", name);
      rule += "---|";
    }
    text += "\n" + rule + "\n";
    for (const std::vector<TableCell>& row : table.rows) {
      text += "|";
      for (const TableCell& cell : row) text += fmt::format(" {} |", cellMarkdown(cell));
      text += "\n";
    }
    return text + "\n";
  }
  std::string operator()(const Figure& figure) const {
    return fmt::format("![{0}]({1}/{2})\n\n*{0}*\n\n", figure.caption, images, figure.file_name);
  }
};

}  // namespace

std::string toHtml(const Document& document) {
  std::string html = fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{}</title>\n{}</head>\n<body>\n<h1>{}</h1>\n<p class=\"soft\">{}</p>\n",
      escapeXml(document.title), kCss, escapeXml(document.title), escapeXml(document.subtitle));
  for (const Block& block : document.blocks) html += std::visit(HtmlBlock{}, block);
  return html + "</body>\n</html>\n";
}

std::string toMarkdown(const Document& document, const std::string& images) {
  std::string text = fmt::format("# {}\n\n{}\n\n", document.title, document.subtitle);
  for (const Block& block : document.blocks) text += std::visit(MarkdownBlock{images}, block);
  text.pop_back();
  return text;
}

}  // namespace agricolmap::compare
