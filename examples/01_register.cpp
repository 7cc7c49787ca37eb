// Registers a robot's cloud into a drone's, both in nearly the same coordinates.
#include <agricolmap/io.hpp>
#include <agricolmap/register.hpp>
#include <exception>
#include <iostream>

int main(int argc, char** argv) try {
  if (argc != 3) throw std::invalid_argument("usage: 01_register DRONE.ply ROBOT.ply");
  const agricolmap::Cloud drone = agricolmap::readCloud(argv[1]);
  const agricolmap::Cloud robot = agricolmap::readCloud(argv[2]);

  const agricolmap::Registration result =
      agricolmap::registerClouds(drone, robot, agricolmap::Transform::Identity());

  std::cout << toString(result.status) << '\n';
  for (const std::string& reason : result.reasons) std::cout << "  " << reason << '\n';
  if (!result.accepted()) return 1;
  agricolmap::writeMatrix("transform.txt", *result.fixed_from_moving);
  agricolmap::writePly("aligned.ply", robot, *result.fixed_from_moving);
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
