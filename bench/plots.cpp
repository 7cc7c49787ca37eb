// agricolmap_plots: the page on locating and its plots, from the rows of campaigns.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <vector>

#include "../apps/agricolmap/exit_code.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/io/output/staged_output.hpp"
#include "locating_page.hpp"

namespace agricolmap::campaign {
namespace {

int run(int argc, char** argv) {
  std::vector<std::string> inputs;
  std::string output;
  std::string preset = "default";
  CLI::App app{"Writes locating.md and its plots from the rows of campaigns."};
  app.name("agricolmap_plots");
  app.add_option("PAIRS", inputs, "pairs.csv of campaigns")->required();
  app.add_option("-o,--output", output, "Folder for locating.md and images/")->required();
  app.add_option("--preset", preset, "Rows of this preset [default]");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : static_cast<int>(ExitCode::kUsage);
  }
  std::vector<PairRow> rows;
  std::vector<std::string> origins;
  for (const std::string& path : inputs) {
    std::string identity;
    const std::vector<PairRow> more = readPairs(path, identity);
    rows.insert(rows.end(), more.begin(), more.end());
    origins.push_back(fmt::format("{} rows of {}: {}", more.size(),
                                  std::filesystem::path(path).filename().string(), identity));
  }
  const std::filesystem::path folder = output;
  std::error_code error;
  std::filesystem::create_directories(folder / "images", error);
  if (error) {
    throw OutputError(fmt::format("{}: cannot be made: {}", output, error.message()));
  }
  for (const PageFile& page : locatingPage(rows, origins, preset)) {
    io::StagedFile file(folder / page.name, true);
    io::writeText(file.path(), page.text);
    file.commit();
    fmt::print("{}\n", (folder / page.name).string());
  }
  return 0;
}

}  // namespace
}  // namespace agricolmap::campaign

int main(int argc, char** argv) {
  try {
    return agricolmap::campaign::run(argc, argv);
  } catch (const agricolmap::Error& error) {
    fmt::print(stderr, "agricolmap_plots: {}\n", error.what());
    return static_cast<int>(agricolmap::exitCodeOf(error.kind()));
  } catch (const std::exception& error) {
    fmt::print(stderr, "agricolmap_plots: {}\n", error.what());
    return static_cast<int>(agricolmap::ExitCode::kInternal);
  }
}
