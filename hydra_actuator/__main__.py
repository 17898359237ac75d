# SPDX-License-Identifier: Apache-2.0
"""Run the command line: `python -m hydra_actuator VERB`."""

import sys

from hydra_actuator.cli.main import main

if __name__ == '__main__':
    sys.exit(main())
