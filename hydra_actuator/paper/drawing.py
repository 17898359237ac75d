# SPDX-License-Identifier: Apache-2.0
"""What the pictures of the statements have in common: panels, labels, colours."""

from hydra_actuator.analysis.palette import BLUE, GREEN, INK, ORANGE, PURPLE, SKY, VERMILION

__all__ = ['BLUE', 'GREEN', 'GREY', 'INK', 'ORANGE', 'PURPLE', 'SKY', 'VERMILION', 'panels']

GREY = '#8a949e'
SIZE = (10.0, 4.2)      # [inch]


def panels(figure, *labels: tuple[str, str], shared: bool = False) -> list:
    """
    Return axes of a figure, one for each (label of x, label of y).

    Side by side, or, with `shared`, above each other on one x axis.
    """
    figure.set_size_inches(*SIZE)
    figure.set_layout_engine('constrained')
    shape = (len(labels), 1) if shared else (1, len(labels))
    axes = figure.subplots(*shape, sharex=shared, squeeze=False).ravel().tolist()
    for one, (x, y) in zip(axes, labels):
        one.set(xlabel=x, ylabel=y)
        one.grid(True, color='#dde1e5', linewidth=0.6)
        one.spines[['top', 'right']].set_visible(False)
    return axes
