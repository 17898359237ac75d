# SPDX-License-Identifier: Apache-2.0
"""
How well the run kept its time, from what the recording holds.

Stamps are the state's instants: in a run without slip their steps equal the period exactly, so
any deviation is a jump in simulated time. How late a tick was computed stands in the node's
diagnostics; how late its message left is the publish time of the message less its stamp.
"""

from dataclasses import dataclass

from hydra_actuator.analysis.series import Report, Series
import numpy as np

REAL_TIME = 'Real time'


@dataclass(frozen=True)
class StampSteps:
    """Steps of the tick stamps: times [s], deviations from the period [s], period [s]."""

    time: np.ndarray
    deviation: np.ndarray
    period: float

    @property
    def missing(self) -> int:
        """How many ticks are missing between the stamps."""
        return int(np.sum(np.maximum(np.rint(self.deviation / self.period), 0)))


def stamp_steps(series: Series) -> StampSteps | None:
    """Return the deviations of the stamps' steps; None for fewer than two ticks."""
    if len(series.stamps) < 2:
        return None
    steps = np.diff(series.stamps)
    period = float(np.median(steps))
    return StampSteps(series.time[1:], (steps - period) * 1e-9, period * 1e-9)


def real_time_reports(series: Series) -> list[Report]:
    """
    Return the node's reports of its real-time statistics, in order of time.

    Events of the same name, such as an overrun, have no count of ticks and are left out.
    """
    found = [r for r in series.diagnostics if r.name.endswith(REAL_TIME) and 'ticks' in r.values]
    return sorted(found, key=lambda report: report.time)


def in_simulated_time(series: Series) -> bool:
    """Tell whether stamps have nothing to do with the system's time: lockstep and the like."""
    return any('mode' in report.values for report in real_time_reports(series))


def numeric_values(reports: list[Report]) -> dict[str, np.ndarray]:
    """Return each key's values over the reports; NaN where one is missing or no number."""
    keys = dict.fromkeys(key for report in reports for key in report.values)
    return {key: np.array([_number(r.values.get(key)) for r in reports]) for key in keys}


def _number(text: str | None) -> float:
    """Return the leading number of a text such as '12.5 us', else NaN."""
    try:
        return float(str(text).split()[0])
    except (ValueError, IndexError):
        return float('nan')


def percentiles_over_time(time: np.ndarray, values: np.ndarray, buckets: int):
    """Return (times [s], {'p50', 'p99', 'max'}: arrays) over buckets of equal duration."""
    edges = np.linspace(time[0], time[-1], buckets + 1)
    places = np.clip(np.searchsorted(edges, time, side='right') - 1, 0, buckets - 1)
    filled = [k for k in range(buckets) if np.any(places == k)]
    groups = [values[places == k] for k in filled]
    return edges[1:][filled], {
        'p50': np.array([np.percentile(g, 50) for g in groups]),
        'p99': np.array([np.percentile(g, 99) for g in groups]),
        'max': np.array([g.max() for g in groups]),
    }
