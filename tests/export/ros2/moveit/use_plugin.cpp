// Solves a pose through the plugin as MoveIt does, and says what was wrong, if anything.

#include <cmath>
#include <cstdio>
#include <memory>

#include <moveit/kinematics_base/kinematics_base.hpp>

kinematics::KinematicsBase* makePlugin();

static int faults = 0;

static void expect(bool holds, const char* what)
{
  if (!holds)
  {
    std::printf("not so: %s\n", what);
    ++faults;
  }
}

int main()
{
  using Values = std::vector<double>;
  const std::unique_ptr<kinematics::KinematicsBase> plugin(makePlugin());
  kinematics::KinematicsBase& solver = *plugin;
  const moveit::core::RobotModel model;
  expect(!solver.initialize(nullptr, model, "manipulator", "world", { "tool0" }, 0.1), "another base is refused");
  expect(solver.initialize(nullptr, model, "manipulator", "base_link", { "tool0" }, 0.1), "it is initialised");
  const Values q = { QS };
  expect(solver.getJointNames().size() == q.size(), "a name a joint");

  std::vector<geometry_msgs::msg::Pose> poses;
  expect(solver.getPositionFK({ "tool0" }, q, poses) && poses.size() == 1, "forward kinematics of the tip");
  expect(!solver.getPositionFK({ "elbow" }, q, poses), "no other link is known");

  moveit_msgs::msg::MoveItErrorCodes code;
  Values found;
  expect(solver.getPositionIK(poses[0], q, found, code) && code.val == code.SUCCESS, "the pose is solved");
  double far = 0.0;
  for (std::size_t i = 0; i < q.size(); ++i)
    far = std::fmax(far, std::fabs(found[i] - q[i]));
  expect(far < 1e-9, "the nearest solution is the seed");

  std::vector<Values> all;
  kinematics::KinematicsResult result;
  expect(solver.getPositionIK(poses, q, all, result, {}) && result.kinematic_error == kinematics::KinematicErrors::OK,
         "all solutions");
  std::printf("%zu solutions\n", all.size());
  for (const Values& one : all)
  {
    std::vector<geometry_msgs::msg::Pose> reached;
    solver.getPositionFK({ "tool0" }, one, reached);
    const auto &a = reached[0], &b = poses[0];
    const double gap = std::fabs(a.position.x - b.position.x) + std::fabs(a.position.y - b.position.y) +
                       std::fabs(a.position.z - b.position.z);
    const double turn = std::fabs(a.orientation.x * b.orientation.x + a.orientation.y * b.orientation.y +
                                  a.orientation.z * b.orientation.z + a.orientation.w * b.orientation.w);
    expect(gap < 1e-8 && turn > 1.0 - 1e-9, "every solution reaches the pose");
  }

  int asked = 0;
  const auto third = [&](const auto&, const Values&, auto& answer) {
    answer.val = ++asked == 3 ? answer.SUCCESS : answer.NO_IK_SOLUTION;
  };
  expect(solver.searchPositionIK(poses[0], q, 1.0, found, third, code) && asked == 3 && found == all[2],
         "the callback chooses");
  const auto never = [](const auto&, const Values&, auto& answer) { answer.val = answer.NO_IK_SOLUTION; };
  expect(!solver.searchPositionIK(poses[0], q, 1.0, found, never, code) && code.val == code.NO_IK_SOLUTION,
         "a callback that accepts none gets none");
  const Values close(q.size(), 1e-6);
  expect(solver.searchPositionIK(poses[0], q, 1.0, close, found, code), "the seed is within narrow limits");
  expect(!solver.searchPositionIK(poses[0], all[1], 1.0, close, found, never, code), "narrow limits and no consent");
  auto outside = poses[0];
  outside.position.x = 99.0;
  expect(!solver.searchPositionIK(outside, q, 1.0, found, code) && code.val == code.NO_IK_SOLUTION, "out of reach");
  expect(!solver.getPositionIK(poses[0], {}, found, code), "a seed of another size");
  return faults;
}
