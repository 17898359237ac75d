# SPDX-License-Identifier: Apache-2.0
"""The errors a person can cause or must know of; the command line prints each as one line."""


class InputError(ValueError):
    """What was given cannot be used: exit code 2. The text names the culprit and its limit."""


class Failure(RuntimeError):
    """What was asked for was tried and did not come about: exit code 1."""
