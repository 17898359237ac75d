# SPDX-License-Identifier: Apache-2.0
"""
Colours that a colour-blind reader tells apart, on light and on dark ground.

Lines: Okabe and Ito, "Color Universal Design" (2008), without black and yellow, which vanish on
one of the two grounds. The two ends of one domain share its colour, the second end is dashed.
Pressure: cividis (Nunez, Anderton and Renslow, 2018). Velocity has a sign: blue to orange.
"""

import numpy as np

BLUE, SKY, GREEN, ORANGE, VERMILION, PURPLE = (
    '#0072B2', '#56B4E9', '#009E73', '#E69F00', '#D55E00', '#CC79A7',
)
LINES = (BLUE, SKY, GREEN, ORANGE, VERMILION, PURPLE)

INK = '#22272c'          # of what is drawn on a map or a white page

PRESSURE_SCALE = 'Cividis'
VELOCITY_STOPS = ('#08366e', '#5b9bd0', '#e8e6e1', '#e09a55', '#7d2b05')
VELOCITY_SCALE = [[k / 4, colour] for k, colour in enumerate(VELOCITY_STOPS)]

_DOMAIN_OF_STATION = {name: k // 2 for k, name in enumerate('OABCDEFGHIJK')}


def line_style(name: str, index: int) -> dict:
    """Return colour and dash of a section: by domain for a station, else by its index."""
    if name in _DOMAIN_OF_STATION:
        second_end = name in 'ACEGIK'
        return {
            'color': LINES[_DOMAIN_OF_STATION[name]],
            'dash': 'dash' if second_end else 'solid',
        }
    dashes = ('solid', 'dash', 'dot', 'dashdot')
    return {
        'color': LINES[index % len(LINES)],
        'dash': dashes[(index // len(LINES)) % len(dashes)],
    }


def sequence(count: int) -> list[str]:
    """Return colours of instants one after the other, early to late, told apart by lightness."""
    stops = np.array([[0x08, 0x36, 0x6e], [0x00, 0x9e, 0x73], [0xe6, 0x9f, 0x00]], float)
    places = np.linspace(0.0, len(stops) - 1.0, max(count, 2))[:count]
    parts = np.stack([np.interp(places, range(len(stops)), stop) for stop in stops.T], axis=1)
    return ['#' + ''.join(f'{round(part):02x}' for part in colour) for colour in parts]
