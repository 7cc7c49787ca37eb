// PNG files written fast, by libpng. cairo's own writer has it compress at zlib's level 6 and takes
// four times as long for files that are hardly smaller: pictures of fields are mostly noise.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace agricolmap::report {

/// An 8-bit RGB picture as PNG. `pixels` are 0x00RRGGBB words, top row first, `stride` words apart.
std::vector<std::uint8_t> encodePng(const std::uint32_t* pixels, int width, int height,
                                    std::size_t stride);

}  // namespace agricolmap::report
