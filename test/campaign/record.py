# SPDX-License-Identifier: Apache-2.0
"""
The record of a campaign: one JSON line per outcome under build/campaign, taken up where it ended.

The file's name holds a hash of the sources that decide outcomes: what another version of the
package has found counts for nothing.
"""

from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import asdict
import hashlib
import json
from pathlib import Path

from campaign.outcome import FAILED, Outcome, RAN, REFUSED, STOPPED

ROOT = Path(__file__).parents[2]
KINDS = (RAN, REFUSED, STOPPED, FAILED)
PROGRESS = 250


def sources() -> Iterable[Path]:
    """Yield the files that decide what becomes of a set."""
    package = ROOT / 'hydra_actuator'
    yield from sorted(package.glob('*.py'))
    for folder in (package / 'core', package / 'parameters', Path(__file__).parent):
        yield from sorted(folder.glob('*.py'))


def place(name: str) -> Path:
    """Return the file that a campaign of this name writes to."""
    digest = hashlib.sha256()
    for source in sources():
        digest.update(source.read_bytes())
    return ROOT / 'build' / 'campaign' / f'{name}-{digest.hexdigest()[:12]}.jsonl'


def carry_out(name: str, count: int, one: Callable[[int], Outcome],
              tell: Callable[[str], None]) -> dict[int, Outcome]:
    """
    Return the outcomes of `count` numbers, those already on record among them.

    one: finds the outcome of a number; tell: is given progress, a line at a time.
    """
    file = place(name)
    file.parent.mkdir(parents=True, exist_ok=True)
    done = read(file)
    with file.open('a', encoding='utf-8') as out:
        if file.stat().st_size:
            # ends a line that was cut off; others are only followed by an empty one
            out.write('\n')
        for number in range(count):
            if number in done:
                continue
            done[number] = one(number)
            out.write(json.dumps({'number': number, **asdict(done[number])}) + '\n')
            out.flush()
            if (number + 1) % PROGRESS == 0:
                tell(f'{name}: {number + 1} of {count}: {totals(done.values())}')
    return {number: done[number] for number in range(count)}


def read(file: Path) -> dict[int, Outcome]:
    """Return the outcomes in a file; a line that was cut off is found anew."""
    done = {}
    lines = file.read_text(encoding='utf-8').splitlines() if file.exists() else []
    for line in lines:
        try:
            found = json.loads(line)
        except ValueError:
            continue
        number = found.pop('number')
        done[number] = Outcome(**found)
    return done


def totals(outcomes: Iterable[Outcome]) -> str:
    """Return how many outcomes there are of each kind."""
    count = Counter(outcome.kind for outcome in outcomes)
    return ', '.join(f'{count[kind]} {kind}' for kind in KINDS)


def summary(outcomes: Iterable[Outcome]) -> str:
    """Return the counts of all kinds and reasons, and how many ran their whole time."""
    outcomes = list(outcomes)
    whole = sum(outcome.kind == RAN and outcome.share >= 1.0 for outcome in outcomes)
    lines = [f'{totals(outcomes)}; {whole} ran all of the time, others for their budget']
    reasons = Counter((o.kind, o.reason) for o in outcomes if o.kind != RAN)
    lines += [f'{count:6} {kind}: {reason}' for (kind, reason), count in reasons.most_common()]
    return '\n'.join(lines)
