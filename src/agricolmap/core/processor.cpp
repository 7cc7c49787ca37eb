#include "agricolmap/core/processor.hpp"

#include "agricolmap/core/error.hpp"

namespace agricolmap {

void requireProcessor() {
#if defined(__x86_64__) && defined(__AVX2__)
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) {
    throw Error(ErrorKind::kInternal,
                "this processor has no AVX2/FMA; build with -DAGRICOLMAP_ARCH= for it");
  }
#endif
}

}  // namespace agricolmap
