# SPDX-License-Identifier: Apache-2.0
"""What happened when: faults, overruns, cavities, stops, resets, as the node reported it."""

from hydra_actuator.analysis.figure import Figure, rows_layout
from hydra_actuator.analysis.palette import BLUE, GREEN, ORANGE, VERMILION
from hydra_actuator.analysis.series import Report, Series
from hydra_actuator.analysis.units import SI, Units
from hydra_actuator.analysis.window import Window
import numpy as np

KEY, TITLE = 'faults', 'Faults and events'
LEVELS = {0: ('ok', GREEN), 1: ('warning', ORANGE), 2: ('error', VERMILION),
          3: ('stale', VERMILION)}
MOST_MARKS = 4000       # of one level


def events(series: Series, shown: Window, units: Units = SI) -> Figure:
    """
    Return every change of what was reported, by its name, above the piston's motion.

    A status that says the same again is no news and is left out.
    """
    news = news_of(series)
    if not news:
        return Figure.absent(KEY, TITLE, 'the recording holds no events and no diagnostics')
    names = list(dict.fromkeys(short(report.name) for report in news))
    traces = []
    for level, (word, colour) in LEVELS.items():
        chosen = [report for report in news if report.level == level][:MOST_MARKS]
        if chosen:
            traces.append({
                'type': 'scatter', 'mode': 'markers', 'name': word, 'xaxis': 'x', 'yaxis': 'y',
                'x': units.time(np.array([report.time for report in chosen])),
                'y': np.array([names.index(short(r.name)) for r in chosen], np.float32),
                'text': [f'{short(r.name)}: {r.message}' for r in chosen],
                'hovertemplate': '%{x:.4f}: %{text}<extra></extra>',
                'marker': {'color': colour, 'size': 9, 'symbol': 'line-ns-open',
                           'line': {'width': 2}}, 'cliponaxis': False,
            })
    kept = slice(None, None, max(1, len(series.time) // 4000))
    traces.append({
        'type': 'scatter', 'mode': 'lines', 'name': 'position', 'xaxis': 'x', 'yaxis': 'y2',
        'x': units.time(series.time[kept]), 'showlegend': False,
        'y': np.asarray(units.travel(series.position[kept]), np.float32),
        'line': {'color': BLUE, 'width': 1.2},
    })
    layout = rows_layout(['', units.travel.label('position')])
    layout['xaxis']['title']['text'] = units.time.label('time')
    layout['xaxis']['range'] = _with_margin(float(units.time(shown.start)),
                                             float(units.time(shown.end)))
    layout['yaxis'].update(tickvals=list(range(len(names))), ticktext=names,
                           range=[len(names) - 0.5, -0.5])
    spans = fault_spans(series)
    layout['shapes'] = [{
        'type': 'rect', 'xref': 'x', 'yref': 'paper', 'y0': 0, 'y1': 1, 'layer': 'below',
        'x0': float(units.time(start)), 'x1': float(units.time(end)), 'fillcolor': VERMILION,
        'opacity': 0.12, 'line': {'width': 0},
    } for _, start, end in spans]
    return Figure(KEY, TITLE, _caption(spans), traces, layout,
                  height=260 + 24 * len(names))


def news_of(series: Series) -> list[Report]:
    """Return the reports that differ in level or message from the one before of that name."""
    last, news = {}, []
    for report in sorted(series.diagnostics, key=lambda one: one.time):
        said = report.level, report.message
        if last.get(report.name) != said:
            news.append(report)
        last[report.name] = said
    return news


def fault_spans(series: Series) -> list[tuple[str, float, float]]:
    """Return (fault, start, end) [s] of every fault at work, from the events about faults."""
    spans, since = [], {}
    for report in sorted(series.diagnostics, key=lambda one: one.time):
        if short(report.name) != 'Faults' or 'enabled' in report.values:
            continue
        for name in report.values:
            if report.level > 0:
                since.setdefault(name, report.time)
            elif name in since:
                spans.append((name, since.pop(name), report.time))
    end = float(series.time[-1])
    return spans + [(name, start, max(end, start)) for name, start in since.items()]


def short(name: str) -> str:
    """Return the name of a status without that of the node."""
    return name.rsplit(': ', 1)[-1]


def _with_margin(start: float, end: float) -> list[float]:
    """Return a range a little wider, so that marks at its ends stand clear of the axis."""
    margin = 0.02 * (end - start)
    return [start - margin, end + margin]


def _caption(spans: list[tuple[str, float, float]]) -> str:
    if not spans:
        return 'Each mark is a change of what was reported. No fault was at work.'
    words = '; '.join(f'{name} from {start:.4g} to {end:.4g} s'
                      for name, start, end in spans[:8])
    more = f' and {len(spans) - 8} more' if len(spans) > 8 else ''
    return f'Each mark is a change of what was reported. Shaded: {words}{more}.'
