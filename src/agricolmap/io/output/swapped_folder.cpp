#include "agricolmap/io/output/swapped_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <system_error>

#include "agricolmap/core/error.hpp"

namespace agricolmap::io {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& shown, const std::error_code& error) {
  throw OutputError(fmt::format("{}: cannot be written: {}", shown, error.message()));
}

/// Where the folder really is, without a slash behind.
fs::path placeOf(const fs::path& dir) {
  std::error_code ignored;
  fs::path place = fs::weakly_canonical(fs::absolute(dir, ignored), ignored);
  return place.has_filename() ? place : place.parent_path();
}

/// Keeps others from a folder that is there, until the descriptor is closed.
int lockedFolder(const fs::path& folder, const fs::path& asked) {
  const int lock = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock >= 0 && ::flock(lock, LOCK_EX | LOCK_NB) != 0) {
    ::close(lock);
    throw OutputError(
        fmt::format("{}: another run is writing it; wait for its end", asked.string()));
  }
  return lock;
}

/// Whether the run that made this hidden folder is no more.
bool isLeftOver(const std::string& hidden) {
  const char* digits = hidden.c_str() + hidden.rfind(".partial-") + sizeof(".partial-") - 1;
  int pid = 0;
  const auto parsed = std::from_chars(digits, hidden.c_str() + hidden.size(), pid);
  return parsed.ec == std::errc() && pid > 0 && ::kill(pid, 0) != 0 && errno == ESRCH;
}

/// Removes what killed runs left, and puts back what one of them had set aside.
void recover(const fs::path& target) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(target.parent_path(), ignored)) {
    const std::string name = entry.path().filename().string();
    if (targetOfHidden(name) != target.filename().string() || !isLeftOver(name)) continue;
    if (!fs::exists(target, ignored)) fs::rename(entry.path() / kSetAside, target, ignored);
    fs::remove_all(entry.path(), ignored);
  }
}

}  // namespace

SwappedFolder::SwappedFolder(const fs::path& dir) {
  const fs::path target = placeOf(dir);
  recover(target);
  lock_ = lockedFolder(target, dir);
  try {
    staged_.emplace(dir, Existing::kReplace);
  } catch (...) {
    if (lock_ >= 0) ::close(lock_);
    throw;
  }
}

SwappedFolder::~SwappedFolder() {
  if (lock_ >= 0) ::close(lock_);
}

void SwappedFolder::keep(const std::string& name) const {
  const OutputPath to = path(name);
  std::error_code error;
  fs::create_hard_link(directory() / name, to.file(), error);
  if (!error) return;
  fs::copy_file(directory() / name, to.file(), error);
  if (error) fail(to.shown(), error);
}

void SwappedFolder::keepOthers(const std::function<bool(const fs::path&)>& foreign) const {
  std::error_code error;
  if (!fs::is_directory(directory(), error)) return;
  const OutputPath fresh = staged_->folder();
  for (const auto& entry : fs::recursive_directory_iterator(directory())) {
    if (entry.is_directory() && !entry.is_symlink()) continue;
    const fs::path name = entry.path().lexically_relative(directory());
    if (fs::exists(fs::symlink_status(fresh.file() / name, error)) || !foreign(name)) continue;
    if (entry.is_symlink()) {
      const OutputPath to = path(name.string());
      fs::copy_symlink(entry.path(), to.file(), error);
      if (error) fail(to.shown(), error);
    } else {
      keep(name.string());
    }
  }
}

}  // namespace agricolmap::io
