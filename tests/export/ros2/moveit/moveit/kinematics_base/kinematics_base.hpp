// What a kinematics plugin sees of MoveIt 2: its base class with the signatures of
// moveit_core/kinematics_base/include/moveit/kinematics_base/kinematics_base.hpp (MoveIt 2.12), and
// messages with the fields that it uses. For the test that compiles the plugin; no ROS is needed.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace geometry_msgs::msg
{
struct Point
{
  double x = 0.0, y = 0.0, z = 0.0;
};

struct Quaternion
{
  double x = 0.0, y = 0.0, z = 0.0, w = 1.0;
};

struct Pose
{
  Point position;
  Quaternion orientation;
};
}  // namespace geometry_msgs::msg

namespace moveit_msgs::msg
{
struct MoveItErrorCodes
{
  int val = 0;
  static constexpr int SUCCESS = 1, NO_IK_SOLUTION = -31;
};
}  // namespace moveit_msgs::msg

namespace rclcpp
{
struct Node
{
  using SharedPtr = std::shared_ptr<Node>;
};
}  // namespace rclcpp

namespace moveit::core
{
struct RobotModel
{
};
}  // namespace moveit::core

namespace kinematics
{
namespace KinematicErrors
{
enum KinematicError
{
  OK = 1,
  UNSUPORTED_DISCRETIZATION_REQUESTED,
  DISCRETIZATION_NOT_INITIALIZED,
  MULTIPLE_TIPS_NOT_SUPPORTED,
  EMPTY_TIP_POSES,
  IK_SEED_OUTSIDE_LIMITS,
  SOLVER_NOT_ACTIVE,
  NO_SOLUTION
};
}  // namespace KinematicErrors
using KinematicError = KinematicErrors::KinematicError;

struct KinematicsQueryOptions
{
  bool lock_redundant_joints = false, return_approximate_solution = false;
};

struct KinematicsResult
{
  KinematicError kinematic_error;
  double solution_percentage;
};

class KinematicsBase
{
public:
  using Pose = geometry_msgs::msg::Pose;
  using Codes = moveit_msgs::msg::MoveItErrorCodes;
  using Options = KinematicsQueryOptions;
  using Values = std::vector<double>;
  using IKCallbackFn = std::function<void(const Pose&, const Values&, Codes&)>;

  virtual ~KinematicsBase() = default;
  virtual bool getPositionIK(const Pose&, const Values&, Values&, Codes&, const Options& = Options()) const = 0;
  virtual bool getPositionIK(const std::vector<Pose>&, const Values&, std::vector<Values>&, KinematicsResult&,
                             const Options&) const
  {
    return false;
  }
  virtual bool searchPositionIK(const Pose&, const Values&, double, Values&, Codes&,
                                const Options& = Options()) const = 0;
  virtual bool searchPositionIK(const Pose&, const Values&, double, const Values&, Values&, Codes&,
                                const Options& = Options()) const = 0;
  virtual bool searchPositionIK(const Pose&, const Values&, double, Values&, const IKCallbackFn&, Codes&,
                                const Options& = Options()) const = 0;
  virtual bool searchPositionIK(const Pose&, const Values&, double, const Values&, Values&, const IKCallbackFn&,
                                Codes&, const Options& = Options()) const = 0;
  virtual bool getPositionFK(const std::vector<std::string>&, const Values&, std::vector<Pose>&) const = 0;
  virtual bool initialize(const rclcpp::Node::SharedPtr&, const moveit::core::RobotModel&, const std::string&,
                          const std::string&, const std::vector<std::string>&, double)
  {
    return false;
  }
  virtual const std::vector<std::string>& getJointNames() const = 0;
  virtual const std::vector<std::string>& getLinkNames() const = 0;

protected:
  rclcpp::Node::SharedPtr node_;
  std::string base_frame_;
  std::vector<std::string> tip_frames_;

  void storeValues(const moveit::core::RobotModel&, const std::string&, const std::string& base_frame,
                   const std::vector<std::string>& tip_frames, double)
  {
    base_frame_ = base_frame;
    tip_frames_ = tip_frames;
  }
};
}  // namespace kinematics
