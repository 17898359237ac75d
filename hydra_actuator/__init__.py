# SPDX-License-Identifier: Apache-2.0
"""
A fast hydraulic servo-actuator, waves included.

The public names load on first use, so that a command starts before its heavy imports do.
"""

from importlib import import_module
import sys
from types import ModuleType

__version__ = '0.1.0'
__all__ = ['Actuator', 'load_parameters', 'load_recording', 'simulate']

_HOMES = {
    'Actuator': 'hydra_actuator.actuator',
    'load_parameters': 'hydra_actuator.parameters',
    'load_recording': 'hydra_actuator.recording.reader',
    'simulate': 'hydra_actuator.simulate',
}


def __getattr__(name: str):
    """Import a public name on first use (PEP 562)."""
    if name not in _HOMES:
        raise AttributeError(f'module {__name__!r} has no attribute {name!r}')
    value = getattr(import_module(_HOMES[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """Return the public names, loaded or not."""
    return sorted({*globals(), *__all__})


class _Package(ModuleType):
    """A package whose public names are never hidden by a module of the same name."""

    def __setattr__(self, name: str, value: object) -> None:
        """Leave out `simulate` the module: importing it would put it in the function's place."""
        if name not in _HOMES or not isinstance(value, ModuleType):
            super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Package
