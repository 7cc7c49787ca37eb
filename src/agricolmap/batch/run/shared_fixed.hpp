// Fixed clouds that the strips of a batch share.
#pragma once

#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "agricolmap/run/pair_files.hpp"

namespace agricolmap::batch {

/// Decoded and sorted once for all who ask, from several threads.
class SharedFixed {
 public:
  /// Decoded now, the first time; what went wrong then is thrown to whoever asks again.
  std::shared_ptr<const run::LoadedFixed> get(const io::MapFiles& files,
                                              const io::CommonFrame& frame);
  std::function<void(std::size_t, std::size_t)> on_pass;

 private:
  struct Entry {
    std::shared_ptr<const run::LoadedFixed> fixed;
    std::exception_ptr error;
  };
  std::mutex mutex_;
  std::map<std::string, Entry> entries_;  ///< by files and frame
};

}  // namespace agricolmap::batch
