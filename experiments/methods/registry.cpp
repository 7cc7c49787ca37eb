// All methods by name.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <functional>
#include <utility>

#include "agricolmap/core/error.hpp"
#include "experiments/methods/cpd_affine.hpp"
#include "experiments/methods/fft_affine.hpp"
#include "experiments/methods/go_icp/go_icp.hpp"
#include "experiments/methods/icp_affine.hpp"
#include "experiments/methods/method.hpp"
#include "experiments/methods/product.hpp"
#ifdef AGRICOLMAP_LIBRARY_PEERS
#include "experiments/methods/features/feature_chain.hpp"
#include "experiments/methods/features/opencv_features.hpp"
#include "experiments/methods/features/surf_features.hpp"
#include "experiments/methods/fpfh/fpfh_gicp.hpp"
#include "experiments/methods/sift_affine.hpp"
#endif

namespace agricolmap::experiments {
namespace {

using Maker = std::function<std::unique_ptr<Method>()>;

/// The peers, in the order in which they are listed. Those of OpenCV, dlib and Open3D only where
/// these are built in.
std::vector<std::pair<std::string, Maker>> peers() {
  return {
      {"icp-affine", [] { return makeIcpAffine(); }},
      {"cpd-affine", [] { return makeCpdAffine(); }},
      {"go-icp", [] { return makeGoIcp(); }},
      {"go-icp-oracle-scale", [] { return withOracleScale(makeGoIcp()); }},
      {"fft-affine", [] { return makeFftAffine(); }},
#ifdef AGRICOLMAP_LIBRARY_PEERS
      {"surf", [] { return makeFeatureChain(makeSurf(), "the paper's chain on SURF"); }},
      {"orb", [] { return makeFeatureChain(makeOrb(), "the paper's chain on ORB"); }},
      {"fast-brief",
       [] { return makeFeatureChain(makeFastBrief(), "the paper's chain on FAST and BRIEF"); }},
      {"sift-affine", [] { return makeSiftAffine(); }},
      {"fpfh-gicp", [] { return makeFpfhGicp(); }},
      {"fpfh-gicp-oracle-scale", [] { return withOracleScale(makeFpfhGicp()); }},
#endif
  };
}

}  // namespace

std::vector<std::string> methodNames() {
  std::vector<std::string> names = productNames();
  for (const auto& [name, make] : peers()) names.push_back(name);
  return names;
}

std::unique_ptr<Method> makeMethod(const std::string& name) {
  if (std::unique_ptr<Method> product = makeProduct(name)) return product;
  for (const auto& [known, make] : peers()) {
    if (known == name) return make();
  }
  throw UsageError(
      fmt::format("unknown method '{}'; there are: {}", name, fmt::join(methodNames(), ", ")));
}

}  // namespace agricolmap::experiments
