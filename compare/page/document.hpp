// A document of headings, paragraphs, tables and figures, as HTML page and as Markdown.
#pragma once

#include <string>
#include <variant>
#include <vector>

namespace agricolmap::compare {

struct Heading {
  std::string text;
};

struct Paragraph {
  std::string text;
};

/// A cell: our figure, and what the paper has in its place (empty: nothing).
struct TableCell {
  std::string ours;
  std::string paper = {};
};

struct Table {
  std::string caption;
  std::vector<std::string> head;
  std::vector<std::vector<TableCell>> rows;  ///< each as long as the head
};

/// A picture: inline in the page, a file beside the Markdown.
struct Figure {
  std::string file_name;  ///< such as success_translation.svg
  std::string caption;
  std::string svg;
};

using Block = std::variant<Heading, Paragraph, Table, Figure>;

struct Document {
  std::string title;
  std::string subtitle;
  std::vector<Block> blocks;
};

/// One file that needs nothing else: no scripts, no fonts, no pictures from elsewhere.
std::string toHtml(const Document& document);
/// `images`: folder of the figures as seen from the file.
std::string toMarkdown(const Document& document, const std::string& images);

}  // namespace agricolmap::compare
