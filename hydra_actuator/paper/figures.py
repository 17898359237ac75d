# SPDX-License-Identifier: Apache-2.0
"""All figures of the paper, by its own numbers, in its order."""

from collections.abc import Callable
from dataclasses import dataclass

from hydra_actuator.paper import (
    figures_net,
    figures_profiles,
    figures_stations,
    figures_surfaces,
)
from hydra_actuator.paper.canvas import draw_styled, new_figure
from hydra_actuator.paper.case import Case

WIDE, PANELS, ONE = (10.4, 4.7), (10.0, 6.4), (9.0, 5.0)     # [inch]


@dataclass(frozen=True)
class PaperFigure:
    """
    A figure of the paper: its number, a title, and what draws it and returns its caption.

    passes: of the runs it needs; fast: whether it is drawn for 200 Hz, too.
    """

    name: str
    title: str
    draw: Callable[..., str]
    size: tuple[float, float]
    passes: tuple[int, ...] = (2,)
    fast: bool = True

    def drawn(self, case: Case) -> tuple[object, str]:
        """Return the matplotlib figure of a case, and its caption."""
        figure = new_figure(self.size)
        return figure, draw_styled(self.draw, figure, case)


def _figures(*rows: tuple) -> dict[str, PaperFigure]:
    return {name: PaperFigure(name, *row) for name, *row in rows}


BOTH = (2, 1)
FIGURES = _figures(
    ('2a', 'Velocity over streamline and time', figures_surfaces.figure_2a, WIDE),
    ('2b', 'Pressure over streamline and time', figures_surfaces.figure_2b, WIDE),
    ('2c', 'Velocity at the twelve stations', figures_stations.figure_2c, (10.0, 8.4)),
    ('2d', 'Pressure at the twelve stations', figures_stations.figure_2d, (10.0, 8.4)),
    ('2e', 'Two passes less one: velocity at the stations', figures_stations.figure_2e, PANELS,
     BOTH),
    ('2f', 'Two passes less one: pressure at the stations', figures_stations.figure_2f, PANELS,
     BOTH),
    ('3a', 'Two passes less one: velocity over streamline and time', figures_surfaces.figure_3a,
     WIDE, BOTH),
    ('3b', 'Two passes less one: pressure over streamline and time', figures_surfaces.figure_3b,
     WIDE, BOTH),
    ('3c', "The piston's two faces", figures_profiles.figure_3c, PANELS),
    ('3d', 'Time levels at 50.570 to 50.577 units', figures_net.figure_3d, (11.0, 5.0), (2,),
     False),
    ('3e', 'Velocity along the streamline at the last moment', figures_profiles.figure_3e, ONE),
    ('3f', 'Pressure along the streamline at the last moment', figures_profiles.figure_3f, ONE),
    ('4a', 'Characteristics in the domain of the piston', figures_net.figure_4a, (9.0, 6.0),
     (2,), False),
    ('4b', 'Characteristics in all domains', figures_net.figure_4b, (11.0, 6.0), (2,), False),
    ('4c', 'Velocity in the first transient, before the waves have crossed',
     figures_profiles.figure_4c, ONE, (2,), False),
    ('4d', 'Pressure in the first transient, before the waves have crossed',
     figures_profiles.figure_4d, ONE, (2,), False),
    ('4e', 'Velocity in the first transient, afterwards', figures_profiles.figure_4e, ONE),
    ('4f', 'Pressure in the first transient, afterwards', figures_profiles.figure_4f, ONE),
    ('5a', 'Command', figures_stations.figure_5a, (10.0, 5.4)),
    ('5b', 'Velocity at all stations', figures_stations.figure_5b, PANELS),
    ('5c', 'Pressure at all stations', figures_stations.figure_5c, PANELS),
    ('5d', 'Velocity, the first wave', figures_stations.figure_5d, (10.0, 4.6), (2,), False),
    ('5e', 'Velocity, the first reflections', figures_stations.figure_5e, (10.0, 4.6), (2,),
     False),
    ('5f', 'Velocity, half a period', figures_stations.figure_5f, (10.0, 4.6), (2,), False),
)
