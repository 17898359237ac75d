# SPDX-License-Identifier: Apache-2.0
"""
What tests of a controller need: fixtures, a loop without middleware, figures of a step.

The names load on first use: pytest imports this package on every start, for its plugin.
"""

from importlib import import_module

__all__ = ['LoopRun', 'run_loop', 'step_metrics', 'StepMetrics']

_HOMES = {
    'LoopRun': 'testing.loop', 'run_loop': 'testing.loop',
    'StepMetrics': 'step_response', 'step_metrics': 'step_response',
}


def __getattr__(name: str):
    """Import a name on first use (PEP 562)."""
    if name not in _HOMES:
        raise AttributeError(f'module {__name__!r} has no attribute {name!r}')
    value = getattr(import_module(f'hydra_actuator.{_HOMES[name]}'), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """Return the names, loaded or not."""
    return sorted({*globals(), *__all__})
