"""Inverse kinematics: which closed form an arm has, and the layer between chains and kernels."""
