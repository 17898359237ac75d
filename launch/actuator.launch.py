# SPDX-License-Identifier: Apache-2.0
"""
Start the actuator node.

    ros2 launch hydra_actuator actuator.launch.py namespace:=left recording:=false
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterFile, ParameterValue
from launch_ros.substitutions import FindPackageShare

# What a launch argument sets: parameter and type.
PARAMETERS = {
    'autostart': ('autostart', bool),
    'recording': ('recording.enabled', bool),
    'recording_directory': ('recording.directory', str),
}


def generate_launch_description() -> LaunchDescription:
    """Return the node with its arguments."""
    shipped = PathJoinSubstitution(
        [FindPackageShare('hydra_actuator'), 'config', 'actuator.yaml'])
    arguments = [
        DeclareLaunchArgument('namespace', default_value='', description='of the node'),
        DeclareLaunchArgument('config', default_value=shipped, description='parameter file'),
        DeclareLaunchArgument(
            'autostart', default_value='true', description='configure and activate by itself'),
        DeclareLaunchArgument(
            'recording', default_value='true', description='record everything to MCAP'),
        DeclareLaunchArgument(
            'recording_directory', default_value='./recordings',
            description='where recordings go'),
    ]
    overrides = {
        parameter: ParameterValue(LaunchConfiguration(argument), value_type=kind)
        for argument, (parameter, kind) in PARAMETERS.items()
    }
    node = Node(
        package='hydra_actuator', executable='actuator_node', name='actuator',
        namespace=LaunchConfiguration('namespace'), output='screen', emulate_tty=True,
        parameters=[ParameterFile(LaunchConfiguration('config')), overrides],
    )
    return LaunchDescription([*arguments, node])
