#include "support/cli_fixture.hpp"

#include <unistd.h>

#include <fstream>
#include <sstream>
#include <stdexcept>

namespace agricolmap::test {
namespace fs = std::filesystem;

CliTest::CliTest() {
  std::string name = (fs::temp_directory_path() / "agricolmap-cli-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
  folder_ = fs::canonical(name);
}

CliTest::~CliTest() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

PairFiles CliTest::pair(const std::string& kind) {
  PairFiles files{fs::path(AGRICOLMAP_PAIRS) / kind};
  if (!fs::exists(files.uav())) {
    throw std::runtime_error(files.folder.string() +
                             " is missing; run 'ctest -R cli.simulate' first");
  }
  return files;
}

std::string CliTest::write(const std::string& name, const std::string& content) const {
  const fs::path path = folder_ / name;
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << content;
  return path;
}

std::set<std::string> CliTest::entries(const std::string& below) const {
  std::set<std::string> names;
  const fs::path top = folder_ / below;
  if (!fs::exists(top)) return names;
  for (const auto& entry : fs::recursive_directory_iterator(top)) {
    names.insert(entry.path().lexically_relative(top).string());
  }
  return names;
}

ProgramResult CliTest::run(const std::vector<std::string>& arguments) {
  ProgramResult result = runAgricolmap(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return result;
}

std::string CliTest::converted(const std::string& from, const std::string& name,
                               const std::vector<std::string>& options) const {
  std::vector<std::string> arguments{"convert", from, inFolder(name), "--quiet"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  run(arguments);
  return inFolder(name);
}

void CliTest::expectFailure(const std::vector<std::string>& arguments, int exit_code,
                            const std::vector<std::string>& parts) const {
  const std::set<std::string> before = entries();
  const ProgramResult result = runAgricolmap(arguments);
  EXPECT_EQ(result.exit_code, exit_code) << result.err;
  for (const std::string& part : parts) {
    EXPECT_NE(result.err.find(part), std::string::npos)
        << "'" << part << "' is not in: " << result.err;
  }
  EXPECT_EQ(entries(), before);
}

nlohmann::json CliTest::errorsOf(const std::string& transform, const PairFiles& files) const {
  const std::string report = inFolder("errors.json");
  const ProgramResult result = runAgricolmap({"evaluate", transform, files.ugv(), "--truth-points",
                                              files.truthPoints(), "-o", report, "--overwrite"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return jsonOf(report);
}

std::string contentOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path.string() + " cannot be read");
  std::ostringstream content;
  content << file.rdbuf();
  return content.str();
}

nlohmann::json jsonOf(const fs::path& path) { return nlohmann::json::parse(contentOf(path)); }

}  // namespace agricolmap::test
