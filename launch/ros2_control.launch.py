# SPDX-License-Identifier: Apache-2.0
"""
Start the actuator, and ros2_control with a forward_command_controller on its valve.

    ros2 launch hydra_actuator ros2_control.launch.py
    ros2 topic pub /valve_controller/commands std_msgs/msg/Float64MultiArray '{data: [1e-4]}'

What goes where is in docs/ros2_control.md.
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import (
    FileContent,
    LaunchConfiguration,
    PathJoinSubstitution,
    PythonExpression,
)
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterFile, ParameterValue
from launch_ros.substitutions import FindPackageShare

CONTROLLERS = ('joint_state_broadcaster', 'valve_controller')
SHARE = FindPackageShare('hydra_actuator')


def generate_launch_description() -> LaunchDescription:
    """Return the actuator, robot_state_publisher, controller manager and its controllers."""
    namespace = LaunchConfiguration('namespace')
    controllers = LaunchConfiguration('controllers')
    description = {
        'robot_description': ParameterValue(
            FileContent(LaunchConfiguration('description')), value_type=str),
        # Frames are the world's, not the namespace's: left/barrel beside right/barrel.
        'frame_prefix': ParameterValue(
            PythonExpression(["'", namespace, "/'.lstrip('/')"]), value_type=str),
    }
    return LaunchDescription([
        DeclareLaunchArgument('namespace', default_value='', description='of all nodes'),
        DeclareLaunchArgument(
            'description', default_value=PathJoinSubstitution([SHARE, 'config', 'actuator.urdf']),
            description='URDF with the ros2_control tag'),
        DeclareLaunchArgument(
            'controllers',
            default_value=PathJoinSubstitution([SHARE, 'config', 'controllers.yaml']),
            description='parameter file of the controllers'),
        # Its other arguments (config, recording, ...) are this file's, too.
        IncludeLaunchDescription(
            PythonLaunchDescriptionSource(
                PathJoinSubstitution([SHARE, 'launch', 'actuator.launch.py'])),
            launch_arguments={'namespace': namespace}.items()),
        Node(
            package='robot_state_publisher', executable='robot_state_publisher',
            namespace=namespace, output='screen', parameters=[description]),
        Node(
            package='controller_manager', executable='ros2_control_node', namespace=namespace,
            output='screen', parameters=[ParameterFile(controllers)]),
        Node(
            package='controller_manager', executable='spawner', namespace=namespace,
            output='screen', arguments=[*CONTROLLERS, '--param-file', controllers]),
    ])
