// PNG files written fast, by libpng. cairo's own writer has it compress at zlib's level 6 and takes
// four times as long for files that are hardly smaller: pictures of fields are mostly noise.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace agricolmap::report {

/// An 8-bit RGB picture as PNG. `pixels` are 0x00RRGGBB words, top row first, `stride` words apart.
std::vector<std::uint8_t> encodePng(const std::uint32_t* pixels, int width, int height,
                                    std::size_t stride);

/// The same for bytes of 1 (grey), 2 (grey, alpha), 3 (RGB) or 4 (RGBA) channels without gaps, made
/// small where the other is made fast: for what is carried about inside a page.
std::vector<std::uint8_t> encodePng(std::span<const std::uint8_t> bytes, int width, int height,
                                    int channels);

}  // namespace agricolmap::report
