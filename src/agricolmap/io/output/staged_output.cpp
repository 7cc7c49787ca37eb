#include "agricolmap/io/output/staged_output.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <set>
#include <system_error>

#include "agricolmap/core/error.hpp"

namespace agricolmap::io {
namespace fs = std::filesystem;
namespace {

constexpr int kMaxAttempts = 1000;

[[noreturn]] void fail(const fs::path& path, std::string_view what, const std::error_code& error) {
  throw OutputError(fmt::format("{}: {}: {}", path.string(), what, error.message()));
}

std::error_code lastError() { return {errno, std::generic_category()}; }

/// Absolute, without symbolic links, dots and trailing slash.
fs::path resolve(const fs::path& path) {
  if (path.empty()) throw OutputError("the output path is empty");
  std::error_code error;
  fs::path resolved = fs::weakly_canonical(fs::absolute(path, error), error);
  if (error) fail(path, "cannot be written", error);
  if (!resolved.has_filename()) resolved = resolved.parent_path();
  if (!resolved.has_filename())
    throw OutputError(fmt::format("{}: not usable as output", path.string()));
  return resolved;
}

/// Makes the folder and its parents; returns those that were missing, innermost first.
std::vector<fs::path> makeParents(const fs::path& folder) {
  std::vector<fs::path> missing;
  std::error_code error;
  for (fs::path p = folder; !fs::exists(fs::status(p, error)); p = p.parent_path()) {
    missing.push_back(p);
    if (!p.has_relative_path()) break;
  }
  for (auto p = missing.rbegin(); p != missing.rend(); ++p) {
    if (::mkdir(p->c_str(), 0777) != 0 && errno != EEXIST) {
      const std::error_code reason = lastError();
      for (auto made = p.base(); made != missing.end(); ++made) {
        fs::remove(*made, error);
      }
      fail(*p, "the folder cannot be made", reason);
    }
  }
  return missing;
}

/// Only folders that are still empty.
void removeParents(const std::vector<fs::path>& parents) noexcept {
  for (const fs::path& p : parents) {
    if (::rmdir(p.c_str()) != 0) return;
  }
}

std::string hiddenPrefix(const fs::path& target) {
  return fmt::format(".{}.partial-", target.filename().string());
}

/// Calls `make` with hidden names until one is free. Process numbers repeat (in containers they are
/// all 1), so the name alone may be taken by what a killed run left behind.
template <typename Make>
fs::path makeHidden(const fs::path& folder, const fs::path& target, const Make& make) {
  const std::string base = fmt::format("{}{}", hiddenPrefix(target), ::getpid());
  for (int i = 0; i < kMaxAttempts; ++i) {
    fs::path hidden = folder / (i == 0 ? base : fmt::format("{}-{}", base, i));
    if (make(hidden)) return hidden;
    if (errno != EEXIST) break;
  }
  fail(target, "cannot be written", lastError());
}

bool isEmptyButForHidden(const fs::path& dir) {
  const std::string prefix = hiddenPrefix(dir);
  std::error_code error;
  fs::directory_iterator entries(dir, error);
  if (error) fail(dir, "cannot be listed", error);
  return std::all_of(begin(entries), end(entries), [&](const fs::directory_entry& entry) {
    return entry.path().filename().string().starts_with(prefix);
  });
}

void renameOrFail(const fs::path& from, const fs::path& to) {
  if (::rename(from.c_str(), to.c_str()) != 0) fail(to, "cannot be put in place", lastError());
}

/// A name that stays inside its folder.
fs::path checkedName(const std::string& name) {
  fs::path path = fs::path(name).lexically_normal();
  if (path.empty() || path.is_absolute() || !path.has_filename() || *path.begin() == ".." ||
      path == ".") {
    throw UsageError(fmt::format("'{}' is no name of a file inside the output folder", name));
  }
  return path;
}

}  // namespace

std::string targetOfHidden(const std::string& name) {
  constexpr std::string_view kMark = ".partial-";
  const std::size_t mark = name.rfind(kMark);
  if (!name.starts_with('.') || mark == std::string::npos || mark == 0) return {};
  const std::string number = name.substr(mark + kMark.size());
  const bool made_so =
      !number.empty() && number.find_first_not_of("0123456789-") == std::string::npos;
  return made_so ? name.substr(1, mark - 1) : "";
}

StagedOutput::StagedOutput(const fs::path& dir, Existing existing)
    : asked_(dir), target_(resolve(dir)), existing_(existing) {
  std::error_code error;
  const fs::file_status status = fs::status(target_, error);
  target_existed_ = fs::exists(status);
  if (target_existed_ && !fs::is_directory(status)) {
    throw OutputError(
        fmt::format("{}: is a file, not a folder to write results into", dir.string()));
  }
  if (target_existed_ && existing == Existing::kRefuse && !isEmptyButForHidden(target_)) {
    throw OutputError(
        fmt::format("{}: the output folder is not empty; name another one, or let what is there be "
                    "replaced",
                    dir.string()),
        Remedy::kOverwrite);
  }
  const bool inside = target_existed_ && existing != Existing::kReplace;
  const fs::path home = inside ? target_ : target_.parent_path();
  made_parents_ = makeParents(home);
  try {
    staging_ =
        makeHidden(home, target_, [](const fs::path& p) { return ::mkdir(p.c_str(), 0777) == 0; });
  } catch (...) {
    removeParents(made_parents_);
    throw;
  }
}

StagedOutput::~StagedOutput() {
  if (staging_.empty()) return;
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
  removeParents(made_parents_);
}

OutputPath StagedOutput::folder() const {
  if (staging_.empty()) throw UsageError("the output was committed already");
  OutputPath folder(staging_ / "new", asked_);
  std::error_code error;
  fs::create_directories(folder.file(), error);
  if (error) fail(folder.shown(), "cannot be written", error);
  return folder;
}

OutputPath StagedOutput::path(const std::string& name) const {
  OutputPath path = folder() / checkedName(name);
  std::error_code error;
  fs::create_directories(path.file().parent_path(), error);
  if (error) fail(path.shown(), "cannot be written", error);
  return path;
}

void StagedOutput::moveAside(const fs::path& name) {
  const fs::path from = target_ / name;
  std::error_code error;
  const fs::file_status status = fs::symlink_status(from, error);
  if (!fs::exists(status)) return;
  if (fs::is_directory(status)) {
    throw OutputError(
        fmt::format("{}: a folder stands where a file should be written", from.string()));
  }
  const fs::path to = staging_ / kSetAside / name;
  fs::create_directories(to.parent_path(), error);
  if (error) fail(from, "cannot be set aside", error);
  renameOrFail(from, to);
  moves_.push_back({from, to});
}

void StagedOutput::rollBack() noexcept {
  for (auto move = moves_.rbegin(); move != moves_.rend(); ++move) {
    ::rename(move->to.c_str(), move->from.c_str());
  }
  moves_.clear();
}

void StagedOutput::mergeInto(const fs::path& fresh, const std::vector<std::string>& stale_names) {
  std::error_code error;
  std::set<fs::path> names;
  for (const auto& entry : fs::recursive_directory_iterator(fresh)) {
    if (!entry.is_directory()) names.insert(entry.path().lexically_relative(fresh));
  }
  try {
    for (const fs::path& name : names) {
      moveAside(name);
      fs::create_directories((target_ / name).parent_path(), error);
      if (error) fail((target_ / name).parent_path(), "the folder cannot be made", error);
      renameOrFail(fresh / name, target_ / name);
      moves_.push_back({fresh / name, target_ / name});
    }
    for (const std::string& stale : stale_names) {
      if (const fs::path name = checkedName(stale); !names.contains(name)) moveAside(name);
    }
  } catch (...) {
    rollBack();
    throw;
  }
}

void StagedOutput::replaceBy(const fs::path& fresh) {
  if (::renameat2(AT_FDCWD, fresh.c_str(), AT_FDCWD, target_.c_str(), RENAME_EXCHANGE) == 0) return;
  if (errno != EINVAL && errno != ENOSYS) fail(target_, "cannot be put in place", lastError());
  const fs::path old = staging_ / kSetAside;
  renameOrFail(target_, old);
  if (::rename(fresh.c_str(), target_.c_str()) == 0) return;
  const std::error_code reason = lastError();
  ::rename(old.c_str(), target_.c_str());
  fail(target_, "cannot be put in place", reason);
}

void StagedOutput::commit(const std::vector<std::string>& stale_names) {
  const fs::path fresh = folder().file();
  if (!target_existed_) {
    renameOrFail(fresh, target_);
  } else if (existing_ == Existing::kReplace) {
    replaceBy(fresh);
  } else {
    mergeInto(fresh, stale_names);
  }
  std::error_code error;
  fs::remove_all(staging_, error);
  staging_.clear();
  made_parents_.clear();
}

StagedFile::StagedFile(const fs::path& path, bool overwrite) : asked_(path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status)) {
    staging_ = target_ = path;  // a device or pipe
    return;
  }
  target_ = resolve(path);
  if (fs::is_directory(status)) {
    throw OutputError(fmt::format("{}: is a folder, not a file to write", path.string()));
  }
  if (fs::exists(status) && !overwrite) {
    throw OutputError(
        fmt::format("{}: exists already; name another file, or let it be replaced", path.string()),
        Remedy::kOverwrite);
  }
  made_parents_ = makeParents(target_.parent_path());
  try {
    staging_ = makeHidden(target_.parent_path(), target_, [](const fs::path& p) {
      const int fd = ::open(p.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      return fd >= 0 && ::close(fd) == 0;
    });
  } catch (...) {
    removeParents(made_parents_);
    throw;
  }
}

StagedFile::~StagedFile() {
  if (committed_ || staging_ == target_) return;
  ::unlink(staging_.c_str());
  removeParents(made_parents_);
}

void StagedFile::commit() {
  if (committed_) throw UsageError("the output was committed already");
  if (staging_ != target_) renameOrFail(staging_, target_);
  committed_ = true;
}

}  // namespace agricolmap::io
