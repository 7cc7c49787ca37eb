#include "agricolmap/io/cloud/xyz_reader.hpp"

#include <fmt/format.h>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/cloud/xyz_columns.hpp"
#include "agricolmap/io/text/text.hpp"

namespace agricolmap::io {

Cloud readXyz(const MappedFile& file, const std::string& name, const ReadOptions& options) {
  const std::string_view text = withoutMark(file.text());
  const XyzColumns found = xyzColumns(text, name);
  AsciiLayout layout;
  layout.name = name;
  layout.text = text.substr(found.begin);
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
  const AsciiSource source(std::move(layout));
  Cloud cloud = assembleCloud(source, name, options.map);
  warnOfRest(source.extraLines(), "lines", cloud);
  cloud.fields = found.fields;
  return cloud;
}

}  // namespace agricolmap::io
