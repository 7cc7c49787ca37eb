#include "experiments/runner/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <utility>

namespace agricolmap::experiments {

Progress::Progress(std::size_t runs) : runs_(runs), terminal_(::isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (terminal_) fmt::print(stderr, "\r\033[K");
}

void Progress::now(std::string place) {
  place_ = std::move(place);
  print();
}

void Progress::done() {
  ++done_;
  print();
}

void Progress::print() const {
  if (!terminal_) return;
  // By the mean of what was done: kinds of pairs come block by block, so that it is soon fair.
  const double left = watch_.seconds() * static_cast<double>(runs_ - done_) /
                      static_cast<double>(done_ > 0 ? done_ : 1) / 3600.0;
  fmt::print(stderr, "\r\033[K{} of {} runs{}; now {}", done_, runs_,
             done_ > 0 ? fmt::format(", {:.1f} h left", left) : "", place_);
  std::fflush(stderr);
}

}  // namespace agricolmap::experiments
