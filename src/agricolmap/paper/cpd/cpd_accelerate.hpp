// Faster fixed points: EM crawls where plants are wider than the kernel, since only their borders
// pull; a few past steps tell where the crawl would end.
#pragma once

#include <Eigen/Core>
#include <deque>

namespace agricolmap::paper {

/// Anderson mixing (Anderson 1965; Walker & Ni 2011) of a map θ → g(θ) towards its fixed point.
class AndersonMixer {
 public:
  explicit AndersonMixer(std::size_t memory) : memory_(memory) {}

  /// The next point to evaluate, from the last one and its image. No step exceeds `limit` (largest
  /// coordinate); the plain image is returned while there is nothing to mix.
  Eigen::VectorXd next(const Eigen::VectorXd& point, const Eigen::VectorXd& image, double limit);

  /// Forgets the past, as after a jump.
  void restart();

 private:
  std::size_t memory_;
  std::deque<Eigen::VectorXd> point_steps_;
  std::deque<Eigen::VectorXd> residual_steps_;
  Eigen::VectorXd last_point_;
  Eigen::VectorXd last_residual_;
};

}  // namespace agricolmap::paper
