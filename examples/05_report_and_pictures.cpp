// What the command line writes: registration.json and pictures. Component pictures.
#include <agricolmap/io.hpp>
#include <agricolmap/register.hpp>
#include <agricolmap/report.hpp>
#include <exception>
#include <filesystem>
#include <iostream>

int main(int argc, char** argv) try {
  if (argc != 4) throw std::invalid_argument("usage: 05_report... DRONE.ply ROBOT.ply FOLDER");
  const agricolmap::Cloud drone = agricolmap::readCloud(argv[1]);
  const agricolmap::Cloud robot = agricolmap::readCloud(argv[2]);
  const std::filesystem::path folder = argv[3];
  std::filesystem::create_directories(folder);

  const agricolmap::Registration result =
      agricolmap::registerClouds(drone, robot, agricolmap::Transform::Identity());
  const std::vector<std::string> pictures = agricolmap::writePictures(folder, result);
  agricolmap::writeReport(folder, result, pictures);
  for (const std::string& picture : pictures) std::cout << picture << '\n';
  return result.accepted() ? 0 : 1;
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
