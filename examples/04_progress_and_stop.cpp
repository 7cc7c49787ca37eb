// A registration beside other work: it says how far it is, and stops when it is told to.
#include <agricolmap/error.hpp>
#include <agricolmap/io.hpp>
#include <agricolmap/register.hpp>
#include <exception>
#include <iostream>
#include <stop_token>
#include <string>
#include <string_view>

int main(int argc, char** argv) try {
  if (argc != 3) throw std::invalid_argument("usage: 04_progress... DRONE.ply ROBOT.ply");
  const agricolmap::Cloud drone = agricolmap::readCloud(argv[1]);
  const agricolmap::Cloud robot = agricolmap::readCloud(argv[2]);
  const agricolmap::Transform guess = agricolmap::Transform::Identity();

  agricolmap::Control control;
  control.threads = 1;
  control.on_stage = [](std::string_view stage) { std::cout << stage << " ...\n"; };
  const agricolmap::Registration result =
      agricolmap::registerClouds(drone, robot, guess, {}, control);
  for (const auto& [stage, seconds] : result.times) {
    std::cout << stage << ": " << seconds << " s\n";
  }

  // Any thread may ask; here the second stage is one too many.
  std::stop_source stop;
  int stages = 0;
  control.stop = stop.get_token();
  control.on_stage = [&](std::string_view) {
    if (++stages == 2) stop.request_stop();
  };
  try {
    agricolmap::registerClouds(drone, robot, guess, {}, control);
  } catch (const agricolmap::Interrupted&) {
    std::cout << "stopped\n";
    return 0;
  }
  std::cerr << "it did not stop\n";
  return 1;
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
