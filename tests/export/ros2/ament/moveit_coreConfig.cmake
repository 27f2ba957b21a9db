# The target of MoveIt's base class, by the name that Humble and later releases export.
add_library(moveit_core::moveit_kinematics_base INTERFACE IMPORTED)
target_include_directories(moveit_core::moveit_kinematics_base INTERFACE ${CMAKE_CURRENT_LIST_DIR}/../moveit)
