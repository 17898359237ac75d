# SPDX-License-Identifier: Apache-2.0
"""The layouts for Foxglove and PlotJuggler show what a recording holds, by its right names."""

import json
from pathlib import Path
import re
import xml.etree.ElementTree as ElementTree

from hydra_actuator.channels import STATIONS
from hydra_actuator.parameters import Parameters
from hydra_actuator.recording import messages
from hydra_actuator.recording.definitions import definition
from hydra_actuator.recording.topics import ActuatorTopics
import pytest

CONFIG = Path(__file__).parents[1] / 'config'
TOPICS = {topic.name: topic.type for topic in ActuatorTopics('/actuator', STATIONS).all()}
FOXGLOVE = json.loads((CONFIG / 'foxglove.json').read_text('utf-8'))
PLOTJUGGLER = ElementTree.parse(CONFIG / 'plotjuggler.xml').getroot()
CURVES = [curve.get('name') for curve in PLOTJUGGLER.iter('curve')]


def foxglove_paths() -> list[str]:
    """Return every message path of the panels."""
    found = []
    for panel in FOXGLOVE['configById'].values():
        found += [path['value'] for path in panel.get('paths', ())]
        found += [panel[key] for key in ('topicToRender', 'topicPath') if key in panel]
    return found


def panels_of(node) -> list[str]:
    """Return the panels a layout places."""
    if isinstance(node, str):
        return [node]
    return [name for key in ('first', 'second') for name in panels_of(node[key])]


def topic_of(name: str, separators: str) -> tuple[str, str]:
    """Return (topic, the rest) by the longest recorded topic that a name begins with."""
    known = [topic for topic in TOPICS
             if name == topic or (name.startswith(topic) and name[len(topic)] in separators)]
    assert known, f'{name} is of no topic of a recording'
    topic = max(known, key=len)
    return topic, name[len(topic) + 1:]


def assert_is_field(topic: str, path: str) -> None:
    """Assert that the first field a path names stands in the definition of the topic's type."""
    own = definition(TOPICS[topic]).partition('=' * 80)[0]
    first = re.split(r'[.\[/]', path)[0]
    assert re.search(rf'^\S+\s+{first}\s*(#.*)?$', own, re.MULTILINE), f'{topic} has no {first}'


def test_foxglove_shows_fields_of_recorded_topics():
    script = FOXGLOVE['userNodes']['field']['sourceCode']
    made = re.search(r'export const output = "(.*)"', script)[1]
    shown = set()
    for path in foxglove_paths():
        if path.startswith(f'{made}.'):
            field = path[len(made) + 1:].partition('[')[0]
            assert re.search(rf'return {{.*\b{field}\b.*}}', script)
            continue
        topic, field = topic_of(path, '.')
        shown.add(topic)
        if field:
            assert_is_field(topic, field)
    inputs = json.loads(re.search(r'export const inputs = (\[.*\])', script)[1])
    assert {TOPICS[name] for name in inputs} == {messages.FLOAT32_ARRAY}
    pressures = {f'/actuator/pressure/{name}' for name in STATIONS}
    assert pressures | {'/joint_states', '/diagnostics', '/actuator/applied'} <= shown


def test_foxglove_places_every_panel_once():
    configured = FOXGLOVE['configById']
    assert FOXGLOVE['layout'] in configured
    tabs = configured[FOXGLOVE['layout']]['tabs']
    placed = [name for tab in tabs for name in panels_of(tab['layout'])]
    assert sorted([*placed, FOXGLOVE['layout']]) == sorted(configured)


@pytest.mark.parametrize('curve', sorted(set(CURVES)))
def test_plotjuggler_draws_what_is_recorded(curve):
    topic, path = topic_of(curve, '/')
    if TOPICS[topic] == messages.JOINT_STATE:
        joint, _, path = path.partition('/')
        parameters = Parameters()
        assert joint in (parameters['command.piston_joint'], parameters['command.valve_joint'])
    assert_is_field(topic, path)


def test_plotjuggler_has_every_pressure_and_tabs_that_are_well_formed():
    assert {f'/actuator/pressure/{name}/fluid_pressure' for name in STATIONS} <= set(CURVES)
    for splitter in PLOTJUGGLER.iter('DockSplitter'):
        areas = splitter.findall('DockArea')
        sizes = [float(size) for size in splitter.get('sizes').split(';')]
        assert int(splitter.get('count')) == len(areas) == len(sizes)
        assert sum(sizes) == pytest.approx(1.0, abs=1e-5)
