#include "agricolmap/7_verdict/verdict.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "agricolmap/core/transform.hpp"

namespace agricolmap {

const char* toString(Status status) {
  return status == Status::kAccepted ? "accepted" : "rejected";
}

void describe(OptionTable& table, VerdictOptions& options) {
  table.number("min_uniqueness", options.min_uniqueness, 0.0, 100.0, "",
               "least ratio of the peak to the highest other peak that the guess allows");
  table.number("min_agreement", options.min_agreement, 0.0, 1.0, "",
               "least share of the blocks that, placed alone, agree with the registration");
  table.number("min_overlap", options.min_overlap, 0.0, 1.0, "",
               "least share of the moving map that must lie on the fixed map");
  table.number("scale_margin", options.scale_margin, 0.0, 1.0, "",
               "how far beyond the prior's limits the scales may come out, relative");
  table.number("heading_margin_deg", options.heading_margin_deg, 0.0, 180.0, "deg",
               "how far beyond the prior's limit the heading may come out");
}

Verdict rejectBecause(std::string reason) { return {Status::kRejected, {std::move(reason)}}; }

Verdict judge(const Evidence& evidence, double overlap, const Eigen::Affine2d& pose,
              const SearchSpace& space, const VerdictOptions& options) {
  std::vector<std::string> against;
  if (overlap < options.min_overlap) {
    against.push_back(
        fmt::format("only {:.0f} % of the moving map lies on the fixed map (at least "
                    "{:.0f} % needed)",
                    100 * overlap, 100 * options.min_overlap));
  }
  if (evidence.uniqueness < options.min_uniqueness) {
    against.push_back(
        fmt::format("another place fits almost as well: the peak is {:.2f} times the "
                    "highest other one (at least {:.2f} needed)",
                    evidence.uniqueness, options.min_uniqueness));
  }
  if (evidence.agreement() < options.min_agreement) {
    against.push_back(
        fmt::format("only {} of {} blocks, placed alone, agree with the whole (at "
                    "least {:.0f} % needed)",
                    evidence.agreeing, evidence.blocks.size(), 100 * options.min_agreement));
  }
  const HorizontalParts parts =
      splitHorizontal(space.scale_axes.transpose() * pose.linear() * space.scale_axes);
  const double scale_limit = std::exp(logScaleLimit(space.uncertainty)) + options.scale_margin;
  for (const auto& [axis, scale] : {std::pair{"x", parts.scale_x}, {"y", parts.scale_y}}) {
    if (!(scale < scale_limit && scale > 1.0 / scale_limit)) {
      against.push_back(
          fmt::format("the scale along {} came out as {:.3f}, beyond what the prior "
                      "allows ({:.3f} to {:.3f})",
                      axis, scale, 1.0 / scale_limit, scale_limit));
    }
  }
  const double heading = std::abs(parts.yaw) * 180.0 / std::numbers::pi;
  if (!(heading <= space.uncertainty.heading_deg + options.heading_margin_deg)) {
    against.push_back(
        fmt::format("the heading came out {:.1f} deg off the prior's, which allows "
                    "{:.1f} deg",
                    heading, space.uncertainty.heading_deg));
  }
  if (!against.empty()) return {Status::kRejected, against};
  return {Status::kAccepted,
          {fmt::format("the peak is {:.2f} times the highest other one", evidence.uniqueness),
           fmt::format("{} of {} blocks, placed alone, agree with the whole", evidence.agreeing,
                       evidence.blocks.size())}};
}

}  // namespace agricolmap
