// What can be set, what can be read off the result, and what can go wrong.
#include <agricolmap/error.hpp>
#include <agricolmap/io.hpp>
#include <agricolmap/options.hpp>
#include <agricolmap/register.hpp>
#include <exception>
#include <iostream>

namespace {

void describe(const agricolmap::Registration& result) {
  std::cout << toString(result.status) << ", right in the plane with a probability of "
            << result.plane_probability << '\n';
  if (result.parts) {
    const agricolmap::Registration::Parts& parts = *result.parts;
    std::cout << "beside the guess: " << parts.shift_m.transpose() << " m, " << parts.heading_deg
              << " degrees, scales " << parts.scale_x << " and " << parts.scale_y << '\n';
  }
  if (result.uncertainty) {
    std::cout << "expected error " << 100.0 * result.uncertainty->expected_rms_m << " cm\n";
  }
  const agricolmap::Registration::Evidence& evidence = result.evidence;
  std::cout << "the next best place is " << evidence.uniqueness << " times worse; "
            << evidence.agreeing_blocks << " of " << evidence.blocks << " blocks agree\n";
  for (const auto& other : result.alternatives) {
    std::cout << "it fits as well at\n" << other.fixed_from_moving.matrix() << '\n';
  }
  for (const std::string& warning : result.warnings) std::cout << "warning: " << warning << '\n';
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 4) throw std::invalid_argument("usage: 02_options... DRONE.ply ROBOT.ply GUESS.txt");
  const agricolmap::Cloud drone = agricolmap::readCloud(argv[1]);
  const agricolmap::Cloud robot = agricolmap::readCloud(argv[2]);
  const agricolmap::Transform guess = agricolmap::readMatrix(argv[3]);

  // A good receiver and a compass: what is not possible need not be searched.
  agricolmap::Options options;
  options.setPrior({.translation_m = 2.0, .heading_deg = 5.0, .scale = 0.1});
  // Everything else goes by name; this is the list of the names.
  for (const agricolmap::OptionInfo& info : options.list()) {
    if (info.name == "verdict.min_probability") {
      std::cout << info.name << ", " << info.limits << ": " << info.help << '\n';
    }
  }
  options.set("verdict.min_probability", 0.9);
  try {
    options.set("verdict.min_probabilty", 0.9);
  } catch (const agricolmap::UsageError& error) {
    std::cout << error.what() << '\n';  // with the name that was meant
  }

  const agricolmap::Registration result = agricolmap::registerClouds(drone, robot, guess, options);
  describe(result);
  return result.accepted() ? 0 : 1;
} catch (const agricolmap::InputError& error) {
  std::cerr << "these clouds cannot be registered: " << error.what() << '\n';
  return 1;
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
