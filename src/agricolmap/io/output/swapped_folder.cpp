#include "agricolmap/io/output/swapped_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <stdio.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <system_error>

#include "agricolmap/core/error.hpp"

namespace agricolmap::io {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& what,
                       const std::error_code& error) {
  throw OutputError(fmt::format("{}: {}: {}", path.string(), what, error.message()));
}

fs::path setAside(const fs::path& target) {
  return target.parent_path() / fmt::format(".{}.old", target.filename().string());
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

/// Whether a folder was left by a run that is no more.
bool isLeftOver(const std::string& name, const std::string& prefix) {
  if (!name.starts_with(prefix)) return false;
  int pid = 0;
  const char* const end = name.data() + name.size();
  const auto parsed = std::from_chars(name.data() + prefix.size(), end, pid);
  if (parsed.ec != std::errc() || parsed.ptr != end || pid <= 0) return false;
  return ::kill(pid, 0) != 0 && errno == ESRCH;
}

/// Removes what killed runs left, and puts back what one of them had set aside.
void recover(const fs::path& target) {
  std::error_code ignored;
  if (const fs::path old = setAside(target); fs::exists(old, ignored)) {
    if (fs::exists(target, ignored)) {
      fs::remove_all(old, ignored);
    } else {
      fs::rename(old, target, ignored);
    }
  }
  const std::string prefix = fmt::format(".{}.next-", target.filename().string());
  for (const auto& entry : fs::directory_iterator(target.parent_path(), ignored)) {
    if (isLeftOver(entry.path().filename().string(), prefix)) {
      fs::remove_all(entry.path(), ignored);
    }
  }
}

}  // namespace

SwappedFolder::SwappedFolder(const fs::path& dir) : asked_(dir) {
  std::error_code error;
  target_ = fs::absolute(dir, error).lexically_normal();
  if (error) fail(dir, "cannot be found", error);
  if (target_.filename().empty()) target_ = target_.parent_path();
  if (fs::exists(target_, error) && !fs::is_directory(target_, error)) {
    throw OutputError(fmt::format("{}: is a file, not a folder for results", dir.string()));
  }
  // A link stays one, and what it leads to is exchanged.
  if (fs::is_symlink(target_, error)) target_ = fs::canonical(target_, error);
  fs::create_directories(target_.parent_path(), error);
  if (error) fail(target_.parent_path(), "the folder cannot be made", error);
  recover(target_);
  lock_ = lockedFolder(target_, asked_);
  staging_ =
      target_.parent_path() / fmt::format(".{}.next-{}", target_.filename().string(), ::getpid());
  fs::remove_all(staging_, error);
  if (fs::create_directory(staging_, error)) return;
  if (lock_ >= 0) ::close(lock_);
  fail(asked_, "cannot be written", error);
}

SwappedFolder::~SwappedFolder() {
  if (lock_ >= 0) ::close(lock_);
  if (committed_) return;
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
}

OutputPath SwappedFolder::path(const std::string& name) const {
  const OutputPath path = OutputPath(staging_, asked_) / name;
  std::error_code error;
  fs::create_directories(path.file().parent_path(), error);
  if (error) fail(path.shown(), "cannot be written", error);
  return path;
}

void SwappedFolder::keep(const std::string& name) const {
  const OutputPath to = path(name);
  std::error_code error;
  fs::create_hard_link(target_ / name, to.file(), error);
  if (!error) return;
  fs::copy_file(target_ / name, to.file(), error);
  if (error) fail(to.shown(), "cannot be written", error);
}

void SwappedFolder::keepOthers(const std::function<bool(const fs::path&)>& foreign) const {
  std::error_code error;
  if (!fs::is_directory(target_, error)) return;
  for (const auto& entry : fs::recursive_directory_iterator(target_)) {
    if (entry.is_directory() && !entry.is_symlink()) continue;
    const fs::path name = entry.path().lexically_relative(target_);
    if (fs::exists(fs::symlink_status(staging_ / name, error)) || !foreign(name)) continue;
    if (entry.is_symlink()) {
      fs::create_directories((staging_ / name).parent_path(), error);
      fs::copy_symlink(entry.path(), staging_ / name, error);
      if (error) fail(asked_ / name, "cannot be written", error);
    } else {
      keep(name.string());
    }
  }
}

void SwappedFolder::commit() {
  if (committed_) throw UsageError("the output was committed already");
  std::error_code error;
  if (!fs::exists(target_, error)) {
    fs::rename(staging_, target_, error);
    if (error) fail(asked_, "cannot be put in place", error);
  } else if (::renameat2(AT_FDCWD, staging_.c_str(), AT_FDCWD, target_.c_str(), RENAME_EXCHANGE) ==
             0) {
    fs::remove_all(staging_, error);
  } else {
    const fs::path old = setAside(target_);
    fs::rename(target_, old, error);
    if (error) fail(asked_, "cannot be set aside", error);
    fs::rename(staging_, target_, error);
    if (error) {
      std::error_code ignored;
      fs::rename(old, target_, ignored);
      fail(asked_, "cannot be put in place", error);
    }
    fs::remove_all(old, error);
  }
  committed_ = true;
}

}  // namespace agricolmap::io
