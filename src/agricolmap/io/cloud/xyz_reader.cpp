#include "agricolmap/io/cloud/xyz_reader.hpp"

#include <memory>
#include <utility>

#include "agricolmap/io/cloud/xyz_columns.hpp"
#include "agricolmap/io/text/text.hpp"

namespace agricolmap::io {

PointFile openXyz(const MappedFile& file, const std::string& name, const ReadOptions& options) {
  const std::string_view text = withoutMark(file.text());
  const XyzColumns found = xyzColumns(text, name);
  AsciiLayout layout;
  layout.name = name;
  layout.text = text.substr(found.begin);
  layout.file = &file;
  layout.columns = found.columns;
  layout.line_end = found.line_end;
  layout.separator = found.separator;
  layout.decimal_comma = found.decimal_comma;
  layout.told_by = "the first one has";
  if (found.announced) layout.points = *found.announced;
  if (found.colours && options.colours) layout.colour = ColourKind::kWideFloat;
  if (found.colours && !options.colours) {
    for (AsciiColumn& column : layout.columns) {
      if (column.use >= AsciiColumn::Use::kRed) column.use = AsciiColumn::Use::kSkip;
    }
  }
  PointFile opened;
  opened.name = name;
  opened.file = &file;
  opened.fields = found.fields;
  auto source = std::make_unique<AsciiSource>(std::move(layout));
  warnOfRest(source->extraLines(), "lines", opened);
  opened.source = std::move(source);
  return opened;
}

}  // namespace agricolmap::io
