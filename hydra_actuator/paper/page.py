# SPDX-License-Identifier: Apache-2.0
"""
The page: figures first, then the paper's statements, then the case; everything inside.

Pictures travel as base64 within the page; a content security policy forbids every connection.
"""

import base64
from dataclasses import dataclass
import html
from importlib import resources
from itertools import groupby

from hydra_actuator.analysis.page import asset, fact_table
from hydra_actuator.paper.case import Case
from hydra_actuator.paper.statement import Statement

TITLE = 'The fast hydraulic actuator of Jankovic et al., figure by figure'
SUBTITLE = (
    'Each figure of the paper by its number, for its own case and, beside it, at 200 Hz; for the '
    "plain model, the paper's, and with cavitation. Units are those of its equation (17): "
    'u/V_max, p/p_max (gauge), x/L along the streamline O to K, t c/L; second axes and captions '
    'give SI. The paper gives no dimensions: those are ours.'
)
VERDICTS = {True: 'confirmed', False: 'refuted', None: 'in part'}


@dataclass(frozen=True)
class Picture:
    """A picture on the page: number, title, what it shows, caption, its PNG and file name."""

    number: str
    title: str
    case: str
    caption: str
    content: bytes
    file: str


def page(pictures: list[Picture], statements: list[tuple[Statement, Picture | None]],
         cases: list[Case]) -> str:
    """Return the page of pictures, statements (with a picture or None) and the cases' facts."""
    parts = {
        'TITLE': html.escape(TITLE),
        'SUBTITLE': html.escape(SUBTITLE),
        'STYLE': asset('style.css'),
        'PICTURES': '\n'.join(_group(number, list(group)) for number, group in groupby(
            pictures, lambda picture: picture.number)),
        'STATEMENTS': _statements(statements),
        'FACTS': '\n'.join(_facts(case) for case in dict.fromkeys(cases)),
    }
    folder = resources.files('hydra_actuator.paper') / 'assets'
    template = (folder / 'page.html').read_text(encoding='utf-8')
    # Split once: what is put in is never searched for further marks.
    pieces = template.split('@')
    return ''.join(parts.get(piece, piece) if k % 2 else piece for k, piece in enumerate(pieces))


def _group(number: str, pictures: list[Picture]) -> str:
    """Return all cases of one figure of the paper under its number."""
    title = f'Figure {number}: {pictures[0].title}'
    shown = '\n'.join(_figure(p, p.case, alone=len(pictures) == 1) for p in pictures)
    return f'<h2 class="group" id="figure_{number}">{html.escape(title)}</h2>\n{shown}'


def _figure(picture: Picture, heading: str, alone: bool = False) -> str:
    """Return one picture with its caption below it."""
    data = base64.b64encode(picture.content).decode('ascii')
    extent = ' class="wide"' if alone else ''
    return (f'<figure{extent}><h3>{html.escape(heading)}</h3>'
            f'<img alt="{html.escape(picture.title)}, {html.escape(picture.case)}" '
            f'src="data:image/png;base64,{data}">'
            f'<figcaption>{html.escape(picture.caption)}</figcaption></figure>')


def _statements(statements: list[tuple[Statement, Picture | None]]) -> str:
    """Return the table of statements and, below it, their pictures."""
    if not statements:
        return ''
    confirmed = [statement.confirmed for statement, _ in statements]
    count = ', '.join(f'{confirmed.count(key)} {word}' for key, word in VERDICTS.items()
                      if key in confirmed)
    heads = ''.join(f'<th scope="col">{name}</th>' for name in (
        'statement', 'quantity', 'the paper', 'ours', 'verdict'))
    bodies = '\n'.join(_rows(statement) for statement, _ in statements)
    shown = '\n'.join(_figure(picture, picture.title) for _, picture in statements if picture)
    return (f'<h2 class="group" id="statements">Statements of the paper: {count}</h2>\n'
            f'<section class="wide scroll"><table><thead><tr>{heads}</tr></thead>\n{bodies}'
            f'</table></section>\n{shown}')


def _rows(statement: Statement) -> str:
    """Return the rows of one statement, a row for each finding."""
    findings = [(f.quantity + (f' [{f.unit}]' if f.unit not in ('', '-') else ''), f.paper, f.ours)
                for f in statement.findings] or [('', '', '')]
    span = f' rowspan="{len(findings)}"'
    first = (f'<td{span}><span class="claim">{html.escape(statement.claim)}</span> '
             f'({html.escape(statement.where)})<p>{html.escape(statement.reason)}</p></td>')
    last = f'<td{span} class="verdict">{VERDICTS[statement.confirmed]}</td>'
    rows = []
    for k, cells in enumerate(findings):
        middle = ''.join(f'<td>{html.escape(cell)}</td>' for cell in cells)
        rows.append(f'<tr>{first if k == 0 else ""}{middle}{last if k == 0 else ""}</tr>')
    return (f'<tbody class="statement" id="statement_{html.escape(statement.name)}">'
            f'{"".join(rows)}</tbody>')


def _facts(case: Case) -> str:
    """Return the table of a case: its units and its run."""
    run = case.run()
    p, ms = run.parameters, run.time_unit * 1e3
    rows = [
        ('L, streamline from pump to tank', f'{run.length_unit:.4g} m'),
        ('c, wave speed', f'{run.length_unit / run.time_unit:.6g} m/s'),
        ('L/c', f'{ms:.5g} ms, 1/{1 / run.time_unit:.4g} s'),
        ('V_max, pump flow over area of the supply line', f'{run.velocity_unit:.5g} m/s'),
        ('p_max, supply pressure', f'{run.pressure_unit / 1e6:.4g} MPa'),
        ('command', f'sine, {run.frequency:g} Hz, {run.amplitude:g} of the stroke'),
        ('cells', f'{p["solver.cells"]}'),
        ('steps', f'{len(run.times) - 1} of {run.step_time * 1e6:.5g} us, '
                  f'{run.tau[-1]:.4g} units of L/c'),
        ('largest |u|/c', f'{run.rows[:, run.channels.MACH].max():.4f}'),
        ('lowest absolute pressure at a station',
         f'{run.rows[:, run.channels.pressure].min() / 1e6:.5g} MPa'),
    ]
    return fact_table(f'The case: {case.title}', '', rows)
