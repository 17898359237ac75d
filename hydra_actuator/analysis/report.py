# SPDX-License-Identifier: Apache-2.0
"""
The report of a recording: one self-contained HTML page, pictures first.

Shows what was recorded and says what was not; computes no physics anew.
"""

from collections.abc import Callable
import os
from pathlib import Path

from hydra_actuator.analysis import (
    boiling,
    facts,
    figure_cavities,
    figure_comparison,
    figure_events,
    figure_fields,
    figure_lines,
    figure_net,
    figure_profiles,
    figure_ranges,
    figure_spectrum,
    figure_timing,
    merits,
    streamline,
)
from hydra_actuator.analysis.figure import Figure
from hydra_actuator.analysis.page import GENERATOR, page
from hydra_actuator.analysis.series import Field, Series
from hydra_actuator.analysis.units import choices, SI, Units
from hydra_actuator.analysis.variants import merged
from hydra_actuator.analysis.window import (
    active_span,
    best_field,
    common_window,
    wave_window,
    whole_run_buckets,
    Window,
    window_of,
)
from hydra_actuator.errors import InputError


def write_report(recording: str | Path, output: str | Path, other: str | Path | None = None,
                 make_units: Callable[[Series], Units] = lambda series: SI) -> Path:
    """
    Write the report of a recording to an HTML file and return its path.

    other: a second recording, with which it is compared; make_units: what the figures are shown
    in first, by the run; the page has a switch.

    An earlier report at `output` is replaced, in one step; any other file there is refused.
    InputError if the recording cannot be read, holds no states, or plotly is missing.
    """
    from hydra_actuator.analysis.extraction import series_of

    output = Path(output)
    check_output(output)
    series = series_of(recording)
    return write_page(output, report_page(
        series, make_units(series), series_of(other) if other else None))


def write_page(output: Path, text: str) -> Path:
    """Write a page in one step and return its path; InputError where it cannot be."""
    draft = output.with_name(f'.{output.name}.{os.getpid()}')
    try:
        draft.write_text(text, encoding='utf-8')
        os.replace(draft, output)
    except OSError as error:
        draft.unlink(missing_ok=True)
        raise InputError(f'cannot write {output}: {error.strerror}') from error
    return output


def check_output(output: Path) -> None:
    """Raise InputError unless a report can be written here without losing anything else."""
    if output.is_dir():
        raise InputError(f'{output} is a directory, not a file for the report')
    if not output.parent.is_dir():
        raise InputError(f'no directory {output.parent} for the report')
    if output.exists():
        with output.open('rb') as present:
            start = present.read(2000)
        if start and GENERATOR.encode() not in start:
            raise InputError(f'{output} exists and is not a report; it is left as it is')


def report_page(series: Series, units: Units = SI, other: Series | None = None) -> str:
    """
    Return the page of a run, compared with another one if there is one.

    units: those shown first.
    """
    ways = choices(series)
    drawn = merged([_pictures(series, one, other) for one in ways.values()])
    tables = _tables(series, 'The run' if other is None else f'The run {series.name}')
    title, warnings = f'Actuator recording {series.name}', boiling.warnings(series)
    if other is not None:
        tables = [*_differences(series, other), *tables]
        title = f'Actuator recordings {series.name} and {other.name}'
        warnings += [f'{other.name}: {words}' for words in boiling.warnings(other)]
    return page(title, _subtitle(series), drawn, tables, warnings, tuple(ways),
                list(ways.values()).index(units))


def _pictures(series: Series, units: Units, other: Series | None) -> list[Figure]:
    """Return the figures of the page in the units given, those of a comparison first."""
    compared = [] if other is None else figure_comparison.comparison(
        series, other, common_window(series, other), units)
    return compared + figures(series, units)


def figures(series: Series, units: Units = SI) -> list[Figure]:
    """Return all figures of a run in the order of the page."""
    shown = window_of(series)
    whole = Window(float(series.time[0]), float(series.time[-1]))
    return [
        *field_figures(series, shown, units),
        figure_lines.sections(series, shown, units),
        figure_lines.piston(series, shown, units),
        figure_lines.command(series, shown, units),
        figure_spectrum.spectrum(series, Window(*active_span(series)), units),
        *figure_cavities.cavities(series, shown, units),
        figure_events.events(series, whole, units),
        *timing_figures(series),
    ]


def timing_figures(series: Series) -> list[Figure]:
    """Return the figures about real time; an offline run has none."""
    if series.source == 'simulate':
        return [Figure.absent('real_time', 'Real time', 'an offline run keeps no real time')]
    return [figure_timing.real_time(series), figure_timing.sending(series),
            figure_timing.stamps(series)]


def field_figures(series: Series, shown: Window, units: Units = SI) -> list[Figure]:
    """Return the figures over streamline and time, from the field or else from the stations."""
    full, stations = series.field, streamline.field_of_stations(series)
    drawn = best_field(full, stations, shown)
    if drawn is None:
        return [Figure.absent('field', 'Pressure over streamline and time',
                              'neither the field nor enough stations were recorded')]
    in_waves = full and wave_window(series, full, shown)
    mapped, window = (full, in_waves) if in_waves else (drawn, shown)
    # A periodic run is told by its periods; another one by the waves, where they are resolved.
    over = shown if shown.frequency else window
    quantities = figure_fields.QUANTITIES
    result = [figure_fields.surface(series, drawn.having(q), over, q, units) for q in quantities]
    result += [figure_fields.wave_map(series, mapped.having(q), window, q, bool(in_waves), units)
               for q in quantities]
    moving = drawn.having('velocity')
    result.append(figure_profiles.over_time(series, moving, over, units))
    result.append(net_figure(series, moving, shown, units))
    if full is None:
        result.append(Figure.absent('whole', 'The whole run', 'the field was not recorded'))
        return result
    buckets = whole_run_buckets(full, shown, figure_fields.WHOLE_RUN_ROWS)
    result += [figure_fields.whole_run_map(full, q, buckets, units) for q in quantities]
    return [*result, figure_ranges.ranges(full, stations, units)]


def net_figure(series: Series, field: Field, shown: Window, units: Units) -> Figure:
    """Return the characteristic net of a few travels, where the recording has parameters."""
    window = figure_net.net_window(series, field, shown) if series.parameters else shown
    return figure_net.net(series, field, window, units)


def _subtitle(series: Series) -> str:
    """Return the run in one line."""
    found = dict(facts.run_facts(series))
    return '; '.join([
        found['duration'], f'{found["states"]} states', f'piston travel {found["piston travel"]}',
        f'written by {found["written by"]}',
    ])


def _tables(series: Series, title: str) -> list[tuple]:
    """Return the tables: facts, under a title, real time, parameters."""
    real_time = facts.real_time_facts(series)
    changed = facts.changed_parameters(series)
    tables = [(title, '', facts.run_facts(series))]
    if real_time:
        tables.append(('Real time over the whole run', '', real_time))
    title = 'Parameters that differ from the defaults'
    return [*tables, (title, _about_parameters(series, changed), changed)]


def _differences(series: Series, other: Series) -> list[tuple]:
    """Return the tables of a comparison: the other run's facts, parameters that differ."""
    names = dict.fromkeys((*series.parameters, *other.parameters))
    rows = [(name, f'{series.parameters.get(name, "-")} / {other.parameters.get(name, "-")}')
            for name in names if series.parameters.get(name) != other.parameters.get(name)]
    return [(f'{series.name} / {other.name} in numbers', '', merits.merits(series, other)),
            (f'Parameters in which {series.name} and {other.name} differ',
             '' if rows else 'None.', rows),
            (f'The run {other.name}', '', facts.run_facts(other))]


def _about_parameters(series: Series, changed: list) -> str:
    """Return what to say where the table of changed parameters is empty."""
    if not series.parameters:
        return 'Not here: the recording holds no parameters.'
    return '' if changed else 'None: every parameter has its default.'
