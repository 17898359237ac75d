# SPDX-License-Identifier: Apache-2.0
"""
One picture of the page: plotly's JSON with numpy arrays in it, and the words around it.

Colours of text, grid and ground are the page's, not the figure's: they follow light and dark.
"""

from dataclasses import dataclass, field

MEGAPASCAL = 1e-6
MILLI = 1e3          # m to mm, s to ms
MICRO = 1e6          # s to us


@dataclass(frozen=True)
class Figure:
    """A picture: unique key, title, caption, traces, layout; `linked` ones share the time axis."""

    key: str
    title: str
    caption: str
    traces: list[dict]
    layout: dict
    height: int = 460           # [px]
    wide: bool = True           # whole width of the page, or half of it
    linked: bool = False        # x is the run's time [s]
    missing: str = field(default='')
    frames: list[dict] = field(default_factory=list)    # of a moving picture: name, data

    @classmethod
    def absent(cls, key: str, title: str, reason: str) -> 'Figure':
        """Return the place of a picture that the recording cannot give, saying why."""
        return cls(key, title, '', [], {}, missing=reason)


def rows_layout(titles: list[str], gap: float = 0.05) -> dict:
    """Return the layout of stacked panels, top first, that share one time axis."""
    count = len(titles)
    height = (1 - gap * (count - 1)) / count
    layout: dict = {'xaxis': {'title': {'text': 'time [s]'}, 'anchor': f'y{count}'}}
    for k, title in enumerate(titles):
        top = 1 - k * (height + gap)
        suffix = '' if k == 0 else str(k + 1)
        layout[f'yaxis{suffix}'] = {
            'title': {'text': title}, 'domain': [max(top - height, 0.0), top],
        }
    if count == 1:
        layout['xaxis']['anchor'] = 'y'
    layout['legend'] = {'orientation': 'h', 'x': 0, 'y': 1.01, 'yanchor': 'bottom'}
    return layout


def logarithmic() -> dict:
    """Return an axis of type log that is labelled 1, 2, 5, 10 ..."""
    values = [digit * 10.0**power for power in range(-3, 8) for digit in (1, 2, 5)]
    return {'type': 'log', 'tickvals': values, 'ticktext': [f'{v:g}' for v in values]}
