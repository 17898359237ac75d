# SPDX-License-Identifier: Apache-2.0
"""`hydra_actuator recover RECORDING -o OUT`: salvage of an unfinished or damaged recording."""

from argparse import ArgumentParser, Namespace
from collections.abc import Iterator

from hydra_actuator.cli.output import refuse_output
from hydra_actuator.cli.progress import ProgressBar

SUMMARY = 'salvage of an unfinished or damaged recording'
LOSSLESS, LOSSY = 0, 3


def add_arguments(parser: ArgumentParser) -> None:
    """Declare the command line."""
    parser.add_argument('recording', help='a recording directory, or one MCAP file; only read')
    parser.add_argument('-o', '--output', required=True, metavar='OUT',
                        help='directory of the new recording')


def run(arguments: Namespace) -> int:
    """Recover, say what is lost; return 0 if that is nothing, else 3."""
    refuse_output(arguments.output)
    from hydra_actuator.recording.recovery import recover

    with ProgressBar('recover') as progress:
        recovery = recover(arguments.recording, arguments.output, progress)
    for line in describe(recovery):
        print(line)
    return LOSSLESS if recovery.lossless else LOSSY


def describe(recovery) -> Iterator[str]:
    """Yield the lines that say what a Recovery gave."""
    topics = sum(count > 0 for count in recovery.messages.values())
    span = (recovery.end_ns - recovery.start_ns) / 1e9 if recovery.messages else 0.0
    yield (f'recovered   {recovery.messages.total()} messages of {topics} topics, {span:.3f} s, '
           f'in {recovery.output}')
    if recovery.lossless:
        yield 'lost        nothing of what the files held'
    if recovery.missing:
        yield f'lost        {recovery.missing.total()} messages that are known of'
        width = max(map(len, recovery.missing))
        for topic, count in sorted(recovery.missing.items()):
            yield f'  {topic:<{width}}  {count}'
    if recovery.unproved:
        yield f'lost        {recovery.unproved} messages whose topic cannot be proved'
    for name in recovery.lost_files:
        yield f'lost        {name}: the file is not there'
    if recovery.run_data_lost:
        yield 'lost        parameters and versions of the run'
    for path, damage in recovery.damages:
        yield (f'damage      {path.name}: {damage.what}, {damage.stop - damage.start} bytes, '
               f'{_span(recovery.start_ns, damage)}')


def _span(origin_ns: int | None, damage) -> str:
    """Return between which sound messages a damage lies [s], counted from the first of all."""
    before, after = (None if stamp is None else f'{(stamp - origin_ns) / 1e9:.3f} s'
                     for stamp in (damage.before_ns, damage.after_ns))
    if before and after:
        return f'between {before} and {after}'
    if before:
        return f'after {before}'
    return f'before {after}' if after else 'no message sound'
