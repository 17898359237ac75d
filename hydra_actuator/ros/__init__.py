# SPDX-License-Identifier: Apache-2.0
"""The actuator as a ROS 2 node: the only rooms that know rclpy."""
