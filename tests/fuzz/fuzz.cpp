// The entry that libFuzzer calls, for the target that AGRICOLMAP_FUZZ_TARGET names.
#include <cstdlib>

#include "targets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const agricolmap::fuzz::Target* const target =
      agricolmap::fuzz::targetOf(AGRICOLMAP_FUZZ_TARGET);
  if (target == nullptr) std::abort();
  agricolmap::fuzz::runOn(*target, {data, size});
  return 0;
}
