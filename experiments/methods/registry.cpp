// All methods by name.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "agricolmap/core/error.hpp"
#include "experiments/methods/method.hpp"
#include "experiments/methods/peers.hpp"
#include "experiments/methods/product.hpp"

namespace agricolmap::experiments {
namespace {

/// In the order in which they are listed. Those of OpenCV, dlib and Open3D only where these are
/// built in.
std::vector<Method> peers() {
  std::vector<Method> all = {
      {"icp-affine", "affine ICP on the vegetation points", {}, icpAffine},
      {"cpd-affine", "affine coherent point drift on the vegetation points", {}, cpdAffine}};
#ifdef AGRICOLMAP_LIBRARY_PEERS
  const Traits matching = {.matches_points = true};
  const Method fpfh = {"fpfh-gicp",
                       "FPFH, fast global registration, generalised ICP (Open3D)",
                       {.rigid = true},
                       fpfhGicp};
  all.insert(all.end(),
             {{"surf", "the paper's chain on SURF", matching, surfChain},
              {"orb", "the paper's chain on ORB", matching, orbChain},
              {"fast-brief", "the paper's chain on FAST and BRIEF", matching, fastBriefChain},
              {"sift-affine", "SIFT and an affine by USAC with MAGSAC++", matching, siftAffine},
              fpfh,
              withOracleScale(fpfh)});
#endif
  return all;
}

}  // namespace

std::vector<std::string> methodNames() {
  std::vector<std::string> names = productNames();
  for (const Method& peer : peers()) names.push_back(peer.name);
  return names;
}

Method makeMethod(const std::string& name) {
  if (const std::optional<Method> product = makeProduct(name)) return *product;
  for (Method& peer : peers()) {
    if (peer.name == name) return std::move(peer);
  }
  throw UsageError(
      fmt::format("unknown method '{}'; there are: {}", name, fmt::join(methodNames(), ", ")));
}

}  // namespace agricolmap::experiments
