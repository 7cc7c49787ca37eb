// Takes out of a map what the field repeats: rows, plant spacing, and whatever else its power
// spectrum is high in.
#pragma once

#include "agricolmap/correlation/fft.hpp"
#include "agricolmap/map/signal_map.hpp"

namespace agricolmap::correlation {

/// Two channels of a map of which the second may be missing (−1).
struct ChannelPair {
  int first = 0;
  int second = -1;
};

/// The map multiplied by the inverse of its own covariance, channel by channel: what an optimal
/// detector correlates a template with. The pair's first channel is the real part, the second the
/// imaginary one, rows × cols of `fft`, which may be larger than the map; zero where the map was
/// not seen.
///
/// Dividing the spectrum by the power would do, were the map periodic. It ends, and has holes, and
/// filters that take rows out are longer than the margin there is: near every edge they would leave
/// rows that look like evidence. The covariance of the seen cells alone is inverted by conjugate
/// gradients, preconditioned with that division.
///
/// `floor`: added to the power, in units of its mean.
ComplexRaster whitenedMap(const map::SignalMap& fixed, ChannelPair channels, const Fft2& fft,
                          double floor);

}  // namespace agricolmap::correlation
