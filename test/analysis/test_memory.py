# SPDX-License-Identifier: Apache-2.0
"""What a report takes of memory does not grow with the field of a run."""

import subprocess
import sys

import pytest

# Prints the peak of the memory [byte] after the figures of each recording in turn. That of
# getrusage would begin with the peak of the process that started this one.
CHILD = """
import re, sys
from pathlib import Path
from hydra_actuator.analysis import boiling, report
from hydra_actuator.analysis.extraction import series_of
for recording in sys.argv[1:]:
    series = series_of(recording)
    report.figures(series)
    boiling.warnings(series)
    status = Path('/proc/self/status').read_text()
    print(1024 * int(re.search(r'VmHWM:\\s+(\\d+) kB', status)[1]))
"""
SHORT, LONG, FIELD_RATE = 0.5, 2.5, 10_000      # [s], [s], [Hz]
# Of what the longer field has more, what the report may take; a copy in memory would be 1.
SHARE = 0.5


@pytest.mark.parametrize('compression', ['none', 'zstd'])
def test_a_field_five_times_as_long_is_not_in_memory(make_run, record, compression):
    runs = [make_run(duration, FIELD_RATE) for duration in (SHORT, LONG)]
    recordings = [record(run, f'run_{k}', compression=compression) for k, run in enumerate(runs)]
    short, long = (8 * run.field.pressure.size for run in runs)
    told = subprocess.run([sys.executable, '-c', CHILD, *recordings],
                          capture_output=True, text=True, check=True).stdout
    before, after = map(int, told.split())
    assert after - before < SHARE * (long - short)
