"""The arm for other programs to build with.

`ros2` writes a ROS 2 package, `source` the solver as source code, `self_test` a program that
checks it; `templates/` are filled by `blanks`.
"""
