#include "experiments/methods/product.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <string_view>
#include <utility>

#include "agricolmap/map/data_term.hpp"
#include "experiments/methods/peer_maps.hpp"

namespace agricolmap::experiments {
namespace {

/// A chain of the product: a preset, and what its flow compares.
struct Chain {
  std::string_view name;
  std::string_view preset;
  map::DataTerm term;
  std::string_view about;
};

// The variants are those of the paper's Tab. IV: only the flow's cost changes. The refinement tells
// plants by their greenness in all of them.
constexpr std::array<Chain, 5> kChains = {{
    {"agricolmap", "paper", map::DataTerm::kExgHeight,
     "the paper's chain: flow on Excess Green and height, vote, affine, CPD"},
    {"agricolmap-rgb", "paper", map::DataTerm::kRgb, "the paper's chain with its flow on colours"},
    {"agricolmap-exg", "paper", map::DataTerm::kExg,
     "the paper's chain with its flow on Excess Green alone"},
    {"agricolmap-height", "paper", map::DataTerm::kHeight,
     "the paper's chain with its flow on height alone"},
    {"default", "default", map::DataTerm::kExgHeight, "the product's default preset"},
}};

class Product : public Method {
 public:
  explicit Product(const Chain& chain) : chain_(chain) {}
  std::string name() const override { return std::string(chain_.name); }
  std::string about() const override { return std::string(chain_.about); }

 protected:
  void attempt(const MethodInput& input, MethodOutcome& outcome) const override {
    pipeline::RegistrationOptions options = pipeline::preset(std::string(chain_.preset));
    options.prior = input.prior;
    options.flow.describe.term = chain_.term;
    const pipeline::Registration result =
        pipeline::registerClouds(input.fixed, input.moving, input.guess, options, outcome.times);
    fillFrom(result, input, outcome);
    if (options.association != pipeline::AssociationKind::kFlow) outcome.matches.reset();
  }

 private:
  Chain chain_;
};

}  // namespace

void fillFrom(const pipeline::Registration& result, const MethodInput& input,
              MethodOutcome& outcome) {
  outcome.accepted = result.verdict.status == verdict::Status::kAccepted;
  if (!outcome.accepted) outcome.why = fmt::format("{}", fmt::join(result.verdict.reasons, "; "));
  if (result.has_transform) outcome.fixed_from_moving = result.fixed_from_moving;
  const locate::AssociationResult& found = result.association;
  const auto count = [&](std::string_view wanted) {
    for (const auto& [name, value] : found.counts) {
      if (name == wanted) return static_cast<std::size_t>(value);
    }
    return std::size_t{0};
  };
  outcome.matches = matchSet(result.frames, input, found.all_matches, count("inliers"));
  if (!found.all_rematches.empty()) {
    outcome.rematches =
        matchSet(result.frames, input, found.all_rematches, count("rematch_inliers"));
  }
}

std::vector<std::string> productNames() {
  std::vector<std::string> names;
  for (const Chain& chain : kChains) names.emplace_back(chain.name);
  return names;
}

std::unique_ptr<Method> makeProduct(const std::string& name) {
  for (const Chain& chain : kChains) {
    if (chain.name == name) return std::make_unique<Product>(chain);
  }
  return nullptr;
}

}  // namespace agricolmap::experiments
