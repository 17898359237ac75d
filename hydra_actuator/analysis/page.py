# SPDX-License-Identifier: Apache-2.0
"""
One HTML page from figures and tables: everything inside, nothing fetched.

Where a figure comes in several units, the page has a switch for them. Arrays travel as base64:
lines as 32-bit floats, times as 32-bit steps and fields as 16-bit steps between their lowest and
highest value, which is finer than any screen. Equal arrays travel once.
A content security policy in the page forbids every connection.
"""

import base64
from collections.abc import Sequence
import hashlib
import html
from importlib import resources
import json

from hydra_actuator.analysis.figure import Figure
from hydra_actuator.analysis.variants import Choice, Rescaled
from hydra_actuator.errors import InputError
import numpy as np

GENERATOR = '<meta name="generator" content="hydra_actuator report">'


class Arrays:
    """The arrays of a page, each kept once, referred to by number."""

    def __init__(self):
        self.packed: list[dict] = []
        self._known: dict[bytes, int] = {}

    def add(self, values: np.ndarray) -> int:
        """Keep an array of one or two dimensions and return its number."""
        packed, raw = _fine(values) if values.ndim == 1 else _stepped(values)
        key = hashlib.sha256(repr(sorted(packed.items())).encode() + raw).digest()
        if key not in self._known:
            self._known[key] = len(self.packed)
            self.packed.append({**packed, 'data': base64.b64encode(raw).decode('ascii')})
        return self._known[key]


def _fine(values: np.ndarray) -> tuple[dict, bytes]:
    """Return description and bytes of a line: times (64-bit) in steps, values as they are."""
    if values.dtype == np.float64:
        return _stepped(values)
    return {'type': 'f4'}, np.ascontiguousarray(values, '<f4').tobytes()


def _stepped(values: np.ndarray) -> tuple[dict, bytes]:
    """Return description and bytes of numbers in steps: 32-bit of times, 16-bit of a field."""
    kind = 'u4' if values.ndim == 1 else 'u2'
    no_number = np.iinfo(kind).max
    finite = np.isfinite(values)
    lowest = float(values[finite].min()) if finite.any() else 0.0
    highest = float(values[finite].max()) if finite.any() else 0.0
    step = (highest - lowest) / (no_number - 1) or 1.0
    steps = np.full(values.shape, no_number, f'<{kind}')
    steps[finite] = np.rint((values[finite] - lowest) / step)
    description = {'type': kind, 'shape': list(values.shape), 'lowest': lowest, 'step': step}
    return description, steps.tobytes()


def figures_json(figures: list[Figure], units: int = 0) -> str:
    """
    Return the figures and their arrays as JSON that may stand inside a script element.

    units: the number of those shown first.
    """
    arrays = Arrays()

    def packed(value):
        if isinstance(value, np.ndarray):
            return {'$array': arrays.add(value)}
        if isinstance(value, Rescaled):
            return {'$array': arrays.add(value.array), '$scales': value.scales}
        if isinstance(value, Choice):
            return {'$units': [packed(one) for one in value.values]}
        if isinstance(value, dict):
            return {key: packed(part) for key, part in value.items()}
        if isinstance(value, (list, tuple)):
            return [packed(part) for part in value]
        return value

    drawn = [
        {'key': f.key, 'traces': packed(f.traces), 'layout': packed(f.layout),
         'frames': packed(f.frames), 'height': f.height, 'linked': f.linked}
        for f in figures if not f.missing
    ]
    text = json.dumps({'figures': drawn, 'arrays': arrays.packed, 'units': units},
                      separators=(',', ':'))
    return text.replace('<', '\\u003c')


def page(title: str, subtitle: str, figures: list[Figure], tables: list[tuple],
         warnings: Sequence[str] = (), units: Sequence[str] = (), chosen: int = 0) -> str:
    """
    Return the page; `tables` holds (title, note, rows of two texts).

    units: the names of those that the figures come in, `chosen` the number of those shown first.
    """
    parts = {
        'TITLE': html.escape(title),
        'SUBTITLE': html.escape(subtitle),
        'WARNINGS': '\n'.join(f'<p class="warning">{html.escape(w)}</p>' for w in warnings),
        'UNITS': _switch(units, chosen),
        'STYLE': asset('style.css'),
        'PICTURES': '\n'.join(_place(figure) for figure in figures),
        'TABLES': '\n'.join(fact_table(*table) for table in tables),
        'FIGURES': figures_json(figures, chosen),
        'PLOTLY': plotly_script(),
        'SCRIPT': asset('draw.js'),
    }
    # Split once: what is put in is never searched for further marks.
    pieces = asset('page.html').split('@')
    return ''.join(parts.get(piece, piece) if k % 2 else piece for k, piece in enumerate(pieces))


def plotly_script() -> str:
    """Return plotly.js as the plotly package carries it; InputError if that is not installed."""
    try:
        from plotly.offline import get_plotlyjs
    except ImportError as error:
        raise InputError(
            'the report needs plotly: pip install hydra_actuator[report]'
        ) from error
    return get_plotlyjs()


def asset(name: str) -> str:
    """Return a file of the room's assets: a template, a style or a script."""
    files = resources.files('hydra_actuator.analysis')
    return (files / 'assets' / name).read_text(encoding='utf-8')


def _switch(units: Sequence[str], chosen: int) -> str:
    """Return the element that chooses the units; nothing if there is no choice."""
    if len(units) < 2:
        return ''
    options = ''.join(
        f'<option value="{k}"{" selected" if k == chosen else ""}>{html.escape(name)}</option>'
        for k, name in enumerate(units))
    return f'<label class="units">Units <select id="units">{options}</select></label>'


def _place(figure: Figure) -> str:
    """Return the element a figure is drawn into, or the words that stand for a missing one."""
    title = html.escape(figure.title)
    if figure.missing:
        return (f'<section class="missing" data-missing="{html.escape(figure.key)}">'
                f'<h2>{title}</h2><p>Not here: {html.escape(figure.missing)}.</p></section>')
    extent = ' class="wide"' if figure.wide else ''
    return (
        f'<figure{extent}><h2>{title}</h2><figcaption>{html.escape(figure.caption)}</figcaption>'
        f'<div class="plot" id="{html.escape(figure.key)}" style="min-height:{figure.height}px">'
        '</div></figure>'
    )


def fact_table(title: str, note: str, rows: list[tuple[str, str]]) -> str:
    """Return a table of two columns, or its note alone if there are no rows."""
    body = ''.join(
        f'<tr><th scope="row">{html.escape(what)}</th><td>{html.escape(value)}</td></tr>'
        for what, value in rows
    )
    words = f'<p>{html.escape(note)}</p>' if note else ''
    return f'<section><h2>{html.escape(title)}</h2>{words}<table>{body}</table></section>'
