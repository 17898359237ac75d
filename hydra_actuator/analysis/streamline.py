# SPDX-License-Identifier: Apache-2.0
"""
Where the nodes of a field are while the piston moves, and the field on an even grid.

    O ---- A|B -- C|D ---- E]piston[F ---- G|H -- I|J ---- K        x from pump to tank

Chamber nodes are fixed in space; the piston faces E and F move. A node the piston has left
behind is laid upon its face, so every frame is a gapless row of (x, value), and a jump between
two domains stays a jump: two nodes at one x. Between nodes the picture is linear.
"""

from hydra_actuator.analysis.series import Field, Series
from hydra_actuator.channels import DOMAINS, STATIONS
import numpy as np

FEWEST_STATIONS = 6


def piston_faces(labels: tuple[str, ...]) -> tuple[int, int] | None:
    """Return the node numbers of the faces E (last of chamber_1) and F (first of chamber_2)."""
    if 'chamber_1' not in labels or 'chamber_2' not in labels:
        return None
    return len(labels) - 1 - labels[::-1].index('chamber_1'), labels.index('chamber_2')


def field_of_stations(series: Series) -> Field | None:
    """
    Return the recorded stations as a field of few nodes; None if there are too few of them.

    Instants at which a station was not recorded are left out.
    """
    places = {name: k for k, name in enumerate(series.section_names)}
    names = [name for name in STATIONS if name in places]
    if len(names) < FEWEST_STATIONS or len(series.section_positions) != len(places):
        return None
    columns = [places[name] for name in names]
    whole = columns == list(range(len(places)))
    # Views where nothing is left out: the stations of a long run take much memory.
    columns = slice(None) if whole else columns
    known = np.isfinite(series.pressure[:, columns]).all(axis=1)
    if np.sum(known) < 2:
        return None
    known = slice(None) if known.all() else known
    labels = tuple(DOMAINS[STATIONS.index(name) // 2] for name in names)
    both = 'E' in names and 'F' in names
    return Field(
        series.time[known], series.section_positions[columns], labels,
        series.pressure[known][:, columns], series.flow_velocity[known][:, columns],
        piston_faces(labels) if both else None,
        f'{len(names)} stations',
    )


def node_positions(field: Field, piston: np.ndarray) -> np.ndarray:
    """Return x [m] of every node in every frame, for the piston position [m] of each frame."""
    x = np.tile(field.positions, (len(field.time), 1))
    if field.faces is None:
        return x
    left, right = field.faces
    face_left = field.positions[left] + piston[:, None]
    face_right = field.positions[right] + piston[:, None]
    labels = np.array(field.labels)
    first, last = labels == 'chamber_1', labels == 'chamber_2'
    x[:, first] = np.minimum(x[:, first], face_left)
    x[:, last] = np.maximum(x[:, last], face_right)
    x[:, [left]] = face_left
    x[:, [right]] = face_right
    return x


def gapless(field: Field, values: np.ndarray) -> np.ndarray:
    """Return a copy of (frames, nodes) values where nodes behind the piston take its face's."""
    filled = np.array(values, dtype=float)
    if field.faces is None:
        return filled
    labels = np.array(field.labels)
    for domain, face in zip(('chamber_1', 'chamber_2'), field.faces):
        block = np.flatnonzero(labels == domain)
        part = filled[:, block]
        filled[:, block] = np.where(np.isnan(part), filled[:, [face]], part)
    return filled


def on_even_grid(x: np.ndarray, values: np.ndarray, grid: np.ndarray) -> np.ndarray:
    """Return gapless (frames, nodes) values on an even grid of x [m], linear between nodes."""
    x = np.maximum.accumulate(x, axis=1)
    return np.stack([np.interp(grid, place, row) for place, row in zip(x, values)])


def extremes_on_even_grid(field: Field, extremes: np.ndarray, grid: np.ndarray,
                          highest: bool) -> np.ndarray:
    """
    Return bucket extremes (buckets, nodes) on an even grid of x [m].

    Where the piston passed within a bucket, both chambers have covered x: the greater extreme
    of the two. The faces themselves move within a bucket and are left out; what no node covered
    is linear between those beside it.
    """
    choose = np.fmax if highest else np.fmin
    labels = np.array(field.labels)
    result = np.full((len(extremes), len(grid)), np.nan)
    for domain in dict.fromkeys(field.labels):
        nodes = np.flatnonzero(labels == domain)
        if field.faces is not None and len(nodes) > 2:
            nodes = nodes[~np.isin(nodes, field.faces)]
        place = field.positions[nodes]
        inside = (grid >= place[0]) & (grid <= place[-1])
        for row, extreme in zip(result, extremes):
            spread = np.interp(grid[inside], place, extreme[nodes])
            row[inside] = choose(row[inside], spread)
    for row in result:
        known = np.isfinite(row)
        if known.any():
            row[~known] = np.interp(grid[~known], grid[known], row[known])
    return result


def boundaries(field: Field) -> list[tuple[float, str]]:
    """Return x [m] and the station letters of every end of a domain, the moving faces left out."""
    labels = field.labels
    letters = {domain: STATIONS[2 * k:2 * k + 2] for k, domain in enumerate(DOMAINS)}
    ends = [(0, letters.get(labels[0], ('', ''))[0])]
    for k in range(1, len(labels)):
        if labels[k] != labels[k - 1] and (field.faces is None or k not in field.faces):
            both = letters.get(labels[k - 1], ('', ''))[1], letters.get(labels[k], ('', ''))[0]
            ends.append((k, '|'.join(both)))
    ends.append((len(labels) - 1, letters.get(labels[-1], ('', ''))[1]))
    return [(float(field.positions[k]), name) for k, name in ends]
