# SPDX-License-Identifier: Apache-2.0
"""
Install hydra_actuator, with pip or with colcon (ament_python).

ROS 2 itself is an extra: whoever has it from apt needs no second one from PyPI.
"""

from glob import glob

from setuptools import find_packages, setup

NAME = 'hydra_actuator'

setup(
    name=NAME,
    version='0.1.0',
    description='A fast hydraulic servo-actuator, waves included, as a ROS 2 node',
    license='Apache-2.0',
    maintainer='hydra_actuator maintainers',
    maintainer_email='maintainers@example.com',
    packages=find_packages(include=[NAME, f'{NAME}.*']),
    package_data={NAME: ['analysis/assets/*', 'paper/assets/*', 'recording/schemas/**/*']},
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{NAME}']),
        (f'share/{NAME}', ['package.xml']),
        (f'share/{NAME}/config', sorted(glob('config/*'))),
        (f'share/{NAME}/launch', sorted(glob('launch/*.py'))),
        (f'share/{NAME}/examples', sorted(glob('examples/*.py'))),
        (f'share/{NAME}/examples/design_study', sorted(glob('examples/design_study/*'))),
    ],
    python_requires='>=3.11,<3.14',
    install_requires=[
        'setuptools', 'numpy>=1.26', 'numba>=0.59', 'mcap>=1.5', 'PyYAML>=6.0',
        # mcap brings these two; chunks are also opened without it.
        'lz4', 'zstandard',
    ],
    extras_require={
        'test': [
            'control', 'dask[distributed]', 'hypothesis', 'imageio-ffmpeg', 'matplotlib',
            'mcap-ros2-support', 'netCDF4', 'pandas', 'playwright', 'plotly', 'pyarrow', 'pytest',
            'pytest-xdist', 'rich', 'rosbags', 'ruff', 'SALib', 'scipy', 'xarray',
        ],
        'ros': [
            'ros-jazzy-rclpy', 'ros-jazzy-common-interfaces', 'ros-jazzy-rmw-fastrtps-cpp',
        ],
        'report': ['matplotlib', 'plotly', 'scipy'],
        'animate': ['imageio-ffmpeg', 'matplotlib', 'pillow'],
        'watch': ['rich'],
        'export': ['netCDF4', 'pandas', 'pyarrow', 'xarray'],
        'response': ['control>=0.10', 'matplotlib', 'scipy'],
        'sweep': [
            'dask[distributed]>=2024.5', 'netCDF4', 'pandas', 'plotly', 'pyarrow', 'SALib>=1.5',
            'scipy', 'xarray',
        ],
    },
    zip_safe=False,
    entry_points={
        'console_scripts': [
            'hydra_actuator = hydra_actuator.cli.main:main',
            'actuator_node = hydra_actuator.cli.main:node_main',
        ],
        'pytest11': ['hydra_actuator = hydra_actuator.testing.plugin'],
    },
)
