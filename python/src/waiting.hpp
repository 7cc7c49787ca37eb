// Long work while Python stays awake: the work has a thread of its own, and the calling thread,
// which holds the interpreter only for moments, looks for Ctrl-C, for who asks to stop, and reports
// stages.
#pragma once

#include <agricolmap/error.hpp>
#include <agricolmap/register.hpp>
#include <chrono>
#include <condition_variable>
#include <future>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "bindings.hpp"

namespace agricolmap::python {

/// What the worker says to the waiting thread.
class Desk {
 public:
  enum class News { kNone, kStage, kDone };

  /// By the worker; returns when the stage was reported, so that what Python does then comes before
  /// what the stage does.
  void enter(std::string_view stage) {
    std::unique_lock lock(mutex_);
    if (muted_) return;
    stage_ = stage;
    changed_.notify_all();
    changed_.wait(lock, [&] { return !stage_ || muted_; });
  }
  void finish() {
    const std::scoped_lock lock(mutex_);
    done_ = true;
    changed_.notify_all();
  }

  /// By the waiting thread; a stage is handed over once.
  std::pair<News, std::string> wait(std::chrono::milliseconds time) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, time, [&] { return stage_ || done_; });
    if (stage_) return {News::kStage, *stage_};
    return {done_ ? News::kDone : News::kNone, {}};
  }
  /// The stage was reported.
  void goOn() {
    const std::scoped_lock lock(mutex_);
    stage_.reset();
    changed_.notify_all();
  }
  /// Nothing is reported any more.
  void mute() {
    const std::scoped_lock lock(mutex_);
    muted_ = true;
    stage_.reset();
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<std::string> stage_;
  bool muted_ = false;
  bool done_ = false;
};

/// Who follows the work from Python.
struct Follower {
  py::object progress;  ///< called with the name of each stage; None: nobody
  py::object stop;      ///< has is_set(), as threading.Event has; None: nobody asks

  /// With the interpreter held. Throws what Python raises, and Interrupted.
  void hear(const std::string& stage) const {
    if (!stage.empty() && !progress.is_none()) progress(stage);
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (!stop.is_none() && stop.attr("is_set")().cast<bool>()) throw Interrupted();
  }
};

/// Returns `work(control)`, with the interpreter free for other threads meanwhile. What the
/// follower throws stops the work and is thrown when that has ended.
template <typename Work>
auto waitFor(const Follower& follower, int threads, const Work& work) {
  constexpr std::chrono::milliseconds kLook(50);
  std::stop_source stop;
  Desk desk;
  Control control;
  control.stop = stop.get_token();
  control.on_stage = [&](std::string_view stage) { desk.enter(stage); };
  control.threads = threads;
  follower.hear({});  // what is short may be done before anybody looks
  const py::gil_scoped_release release;
  auto result = std::async(std::launch::async, [&] {
    struct Finally {
      Desk& desk;
      ~Finally() { desk.finish(); }
    } const finally{desk};
    return work(std::as_const(control));
  });
  std::exception_ptr wish;
  while (true) {
    const auto [news, stage] = desk.wait(kLook);
    if (news == Desk::News::kDone) break;
    if (!wish) {
      const py::gil_scoped_acquire acquire;
      try {
        follower.hear(stage);
      } catch (...) {
        wish = std::current_exception();
        stop.request_stop();
        desk.mute();
      }
    }
    if (news == Desk::News::kStage) desk.goOn();
  }
  if (!wish) return result.get();
  result.wait();
  std::rethrow_exception(wish);
}

}  // namespace agricolmap::python
