// Points that never were in a file, as from a driver or a point cloud library: here those of two
// files, taken apart. The robot's are in coordinates of its own, and the guess says where they lie.
#include <Eigen/Geometry>
#include <agricolmap/io.hpp>
#include <agricolmap/register.hpp>
#include <exception>
#include <iostream>
#include <vector>

namespace {

struct MyPoints {
  std::vector<Eigen::Vector3d> xyz;
  std::vector<agricolmap::Rgb> rgb;
};

MyPoints pointsOf(const agricolmap::Cloud& cloud, const Eigen::Affine3d& target_from_file) {
  MyPoints points;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    points.xyz.push_back(target_from_file * cloud.filePoint(i));
  }
  points.rgb = cloud.rgb;
  return points;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 4) throw std::invalid_argument("usage: 03_own_points DRONE.ply ROBOT.ply GUESS.txt");
  // Eigen's own transformations go in and come out.
  const Eigen::Affine3d drone_from_robot = agricolmap::readMatrix(argv[3]);
  const Eigen::Affine3d robot_from_mine(Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitZ()));

  const MyPoints drone = pointsOf(agricolmap::readCloud(argv[1]), Eigen::Affine3d::Identity());
  const MyPoints robot = pointsOf(agricolmap::readCloud(argv[2]), robot_from_mine.inverse());

  const agricolmap::Cloud fixed = agricolmap::makeCloud(drone.xyz, drone.rgb, "drone");
  const agricolmap::Cloud moving = agricolmap::makeCloud(robot.xyz, robot.rgb, "robot");
  const Eigen::Affine3d guess = drone_from_robot * robot_from_mine;
  const agricolmap::Registration result = agricolmap::registerClouds(fixed, moving, guess);
  if (!result.accepted()) {
    std::cout << toString(result.status) << ": " << result.reasons.front() << '\n';
    return 1;
  }
  const Eigen::Affine3d drone_from_mine = *result.fixed_from_moving;
  std::cout << "my first point lies at " << (drone_from_mine * robot.xyz.front()).transpose()
            << " in the drone's map\n";
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
