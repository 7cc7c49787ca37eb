#include "agricolmap/simulate/field/colour_response.hpp"

#include <algorithm>
#include <cmath>

#include "agricolmap/simulate/field/noise.hpp"

namespace agricolmap::simulate {

namespace {
constexpr int kCurveSteps = 4096;
}

ColourResponse::ColourResponse(const ColourOptions& options, double mean_light, std::uint64_t seed)
    : options_(options), seed_(seed), curve_(kCurveSteps + 1) {
  Random random = Random::stream(seed, 3);
  // The mean comes out at 18 % of full scale before the tone curve, as cameras meter.
  const double exposure = options.exposure * 0.18 / std::max(1e-4, mean_light);
  gains_ = {static_cast<float>(exposure * std::exp(random.normal(options.white_balance))),
            static_cast<float>(exposure),
            static_cast<float>(exposure * std::exp(random.normal(options.white_balance)))};
  const double gamma = 0.45 * std::exp(random.normal(options.gamma_spread));
  for (int i = 0; i <= kCurveSteps; ++i) {
    const double light = static_cast<double>(i) / kCurveSteps;
    curve_[static_cast<std::size_t>(i)] = static_cast<float>(255.0 * std::pow(light, gamma));
  }
}

Rgb ColourResponse::operator()(const std::array<float, 3>& radiance, const Eigen::Vector2d& place,
                               Random& random) const {
  const float field = noiseAt(seed_, place.x() / 5.0, place.y() / 5.0);
  const float brightness = std::max(0.2F, 1.0F + static_cast<float>(options_.gradient) * field);
  const float grey =
      (radiance[0] * gains_[0] + radiance[1] * gains_[1] + radiance[2] * gains_[2]) / 3.0F;
  const auto saturation = static_cast<float>(options_.saturation);
  // One draw of 64 bits gives three channels of near-normal noise (sums of three uniforms).
  const std::uint64_t a = random.bits();
  const std::uint64_t b = random.bits();
  const auto noise_scale = static_cast<float>(options_.noise * 2.0 / 65536.0);
  std::array<std::uint8_t, 3> out{};
  for (std::size_t k = 0; k < 3; ++k) {
    const float value = brightness * (grey + saturation * (radiance[k] * gains_[k] - grey));
    const float clamped = std::clamp(value, 0.0F, 1.0F) * static_cast<float>(kCurveSteps);
    const auto index = static_cast<std::size_t>(std::min(clamped, kCurveSteps - 1.0F));
    const float part = clamped - static_cast<float>(index);
    const float tone = curve_[index] + part * (curve_[index + 1] - curve_[index]);
    const auto n1 = static_cast<float>((a >> (16 * k)) & 0xFFFF);
    const auto n2 = static_cast<float>((b >> (16 * k)) & 0xFFFF);
    const auto n3 = static_cast<float>(((a ^ (b >> 7)) >> (13 * k + 5)) & 0xFFFF);
    const float noisy = tone + noise_scale * (n1 + n2 + n3 - 98304.0F);
    out[k] = static_cast<std::uint8_t>(std::clamp(noisy + 0.5F, 0.0F, 255.0F));
  }
  return {out[0], out[1], out[2]};
}

}  // namespace agricolmap::simulate
