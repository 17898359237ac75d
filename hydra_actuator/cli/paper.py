# SPDX-License-Identifier: Apache-2.0
"""`hydra_actuator paper -o DIR`: the paper's case, its figures, its statements."""

import argparse

from hydra_actuator.cli.output import refuse_output
from hydra_actuator.cli.progress import ProgressBar

SUMMARY = 'every figure of the paper, and its statements beside our numbers'


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the verb."""
    parser.add_argument('-o', '--output', metavar='DIR', default='paper',
                        help='directory of the pictures and of paper.html (default paper)')
    parser.add_argument('--only', nargs='+', metavar='FIGURE', default=[],
                        help='figures, as 2a or figure_2a, or statements by name; default: all')
    model = parser.add_mutually_exclusive_group()
    model.add_argument('--plain', action='store_true', help="the plain model, the paper's, only")
    model.add_argument('--cavitation', action='store_true', help='with cavitation only')


def run(arguments: argparse.Namespace) -> int:
    """Draw everything and name the page."""
    refuse_output(arguments.output)
    from hydra_actuator.paper.choice import choose
    choice = choose(arguments.only, plain=not arguments.cavitation,
                    cavitation=not arguments.plain)
    from hydra_actuator.paper.production import write_paper
    with ProgressBar('paper') as progress:
        page = write_paper(arguments.output, choice, progress)
    print(f'{len(choice.pictures)} figures and {len(choice.statements)} statements in {page}')
    return 0
