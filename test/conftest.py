# SPDX-License-Identifier: Apache-2.0
"""What holds for all tests: ROS messages check the types of their fields."""

import os

# Read when a message is first imported, here and in the processes that tests start.
os.environ['ROS_PYTHON_CHECK_FIELDS'] = '1'
