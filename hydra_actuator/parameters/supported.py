# SPDX-License-Identifier: Apache-2.0
"""
Options that have their place in the table but are not available in this version.

They are refused, so that none is ever ignored in silence.
"""

from collections.abc import Mapping

from hydra_actuator.parameters.definition import ParameterError, Value

# What is available of each parameter that is restricted.
AVAILABLE: dict[str, tuple[Value, ...]] = {
    'recording.mode': ('continuous',),
}


def refuse_unavailable(values: Mapping[str, Value]) -> None:
    """Raise ParameterError on the first option that this version does not have."""
    for name, available in AVAILABLE.items():
        if values[name] not in available:
            raise ParameterError(
                f'{name} = {_text(values[name])} is not available in this version; '
                f'use {" or ".join(map(_text, available))}'
            )


def _text(value: Value) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)
