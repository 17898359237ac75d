# SPDX-License-Identifier: Apache-2.0
"""What is observed, and how the actuator runs: commands, instruments, time, output."""

from hydra_actuator.channels import STATIONS
from hydra_actuator.parameters.definition import (
    boolean,
    double,
    group,
    integer,
    Parameter,
    string,
)

_RATE = (0.0, 20000.0)

SECTIONS = group(
    'sections',
    Parameter('names', 'string_array', STATIONS,
              'stations O to K, or own names with a position each'),
    Parameter('positions', 'double_array', (),
              'along the streamline, fixed in space; one per own name, in order',
              'm', 0.0, 1e5),
)

COMMAND = group(
    'command',
    double('max_age', 0.0, 's', (0.0, 3600.0),
           'how far the stamp of a joint command may be from now either way; 0: not judged'),
    double('timeout', 0.0, 's', (0.0, 3600.0), 'silence after which on_timeout acts; 0: off'),
    string('on_timeout', 'hold', 'what the spool does then', ('hold', 'centre')),
    double('scale', 1.0, '1', (1e-9, 1e9),
           'a command of this size is full spool; 10 for a 10 V amplifier'),
    string('piston_joint', 'piston', 'name of the piston in joint states'),
    string('valve_joint', 'valve', 'name of the spool in joint states and joint commands'),
    live=True,
)

SENSOR = group(
    'sensor',
    double('position_noise', 0.0, 'm', (0.0, 1.0), 'standard deviation'),
    double('velocity_noise', 0.0, 'm/s', (0.0, 100.0), 'standard deviation'),
    double('pressure_noise', 0.0, 'Pa', (0.0, 1e8), 'standard deviation'),
    double('position_resolution', 0.0, 'm', (0.0, 1.0), 'smallest step; 0: none'),
    double('pressure_resolution', 0.0, 'Pa', (0.0, 1e8), 'smallest step; 0: none'),
    double('delay', 0.0, 's', (0.0, 10.0), 'of every reading'),
    integer('seed', 0, (0, 2**31 - 1), 'of the noise'),
    live=True,
)

TIMING = group(
    'timing',
    string('mode', 'realtime', 'what time follows',
           ('realtime', 'lockstep', 'follow_clock', 'free_run')),
    double('period', 1e-3, 's', (1e-4, 1.0), 'of one tick: commands apply, states go out'),
    double('speed', 1.0, '1', (1e-3, 1e3), 'simulated over real time, in mode realtime'),
    double('lockstep_period', 1e-3, 's', (1e-4, 10.0), 'that one command advances'),
    boolean('free_wheel', False, 'lockstep: run until the first command'),
    string('overrun_policy', 'burst', 'after missed ticks: catch up, declare slip, or stop',
           ('burst', 'slip', 'halt')),
    integer('max_burst', 100, (1, 100000), 'most ticks caught up at once, the rest is slip'),
    integer('thread_priority', 0, (0, 99), 'of the solver thread under SCHED_FIFO; 0: normal'),
    Parameter('cpu_affinity', 'integer_array', (), 'cores of the solver thread; empty: any',
              '', 0, 4095),
    boolean('lock_memory', False, 'keep all memory in RAM (mlockall)'),
)

PUBLISH = group(
    'publish',
    double('rate', 1000.0, 'Hz', (1.0, 20000.0), 'of joint states; once a tick at most'),
    double('pressure_rate', 1000.0, 'Hz', _RATE, 'of each pressure; 0: none'),
    double('sections_rate', 1000.0, 'Hz', _RATE, 'of the array of all sections; 0: none'),
    boolean('field', False, 'publish the field as it is recorded'),
    boolean('clock', False, 'publish /clock'),
    double('clock_rate', 100.0, 'Hz', (1.0, 20000.0), 'of /clock'),
)

RECORDING = group(
    'recording',
    boolean('enabled', True, 'record everything to MCAP'),
    string('directory', './recordings', 'where recordings go, each into a folder of its own'),
    string('mode', 'continuous', 'all, or the last moments on request',
           ('continuous', 'snapshot')),
    double('snapshot_duration', 10.0, 's', (0.1, 3600.0), 'kept for a snapshot'),
    double('field_rate', 200.0, 'Hz', _RATE, 'of the whole field; 0: none'),
    double('flush_period', 0.5, 's', (0.01, 60.0), 'most that a crash can lose'),
    integer('split_size', 0, (0, 2**50), 'of a file before the next begins; 0: never', 'B'),
    double('split_duration', 0.0, 's', (0.0, 1e7), 'of a file before the next; 0: never'),
    string('compression', 'none', 'of the chunks', ('none', 'zstd')),
    integer('min_free_space', 0, (0, 2**60),
            'left on the disk; recording pauses below; 0: no limit', 'B'),
)

AUTOSTART = (boolean('autostart', True, 'configure and activate without being asked'),)

RUNNING = (
    *AUTOSTART, *SECTIONS, *COMMAND, *SENSOR, *TIMING, *PUBLISH, *RECORDING,
)
