# SPDX-License-Identifier: Apache-2.0
"""What can go wrong with a recording: before it is opened, or while it is written."""

from hydra_actuator.errors import Failure, InputError


class RecordingError(InputError):
    """The recording cannot be opened, read or created as asked; the text names the path."""


class RecordingFailure(Failure):
    """Writing broke off, as on a full disk; what was written before stays readable."""
