# SPDX-License-Identifier: Apache-2.0
"""What an installation holds, and that the package says the same of itself everywhere."""

from pathlib import Path
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

import hydra_actuator
import pytest

ROOT = Path(__file__).parents[1]
PACKAGE_XML = ElementTree.parse(ROOT / 'package.xml').getroot()
# What the installation is made of; the folders of the package come with it whole.
SOURCES = ('hydra_actuator', 'config', 'launch', 'resource', 'examples')
FILES = ('setup.py', 'setup.cfg', 'package.xml')


@pytest.fixture(scope='module')
def installed(tmp_path_factory):
    """Return the prefix of an installation as colcon makes it, by setup.py and setup.cfg."""
    folder = tmp_path_factory.mktemp('install')
    tree, prefix = folder / 'tree', folder / 'prefix'
    for name in SOURCES:
        if (ROOT / name).exists():
            shutil.copytree(ROOT / name, tree / name)
    for name in FILES:
        shutil.copy(ROOT / name, tree / name)
    subprocess.run(
        [sys.executable, '-W', 'ignore', 'setup.py', '-q', 'install', '--prefix', prefix,
         '--single-version-externally-managed', '--record', folder / 'record'],
        cwd=tree, check=True, capture_output=True,
    )
    return prefix


def test_commands_are_where_ros_looks_for_them(installed):
    found = {path.name for path in (installed / 'lib' / 'hydra_actuator').iterdir()}
    assert found == {'hydra_actuator', 'actuator_node'}


def test_package_is_in_the_index_of_ament(installed):
    assert (installed / 'share/ament_index/resource_index/packages/hydra_actuator').exists()
    assert (installed / 'share/hydra_actuator/package.xml').exists()


@pytest.mark.parametrize('folder', ['config', 'launch', 'examples'])
def test_shipped_files_are_installed(installed, folder):
    source = {path.name for path in (ROOT / folder).glob('*.*')}
    target = {path.name for path in (installed / 'share/hydra_actuator' / folder).glob('*.*')}
    assert target == source


def test_every_source_and_data_file_of_the_package_is_installed(installed):
    def content(folder):
        return {
            str(path.relative_to(folder)) for path in folder.rglob('*')
            if path.is_file() and '__pycache__' not in path.parts
        }
    (target,) = installed.glob('lib*/python*/site-packages/hydra_actuator')
    assert content(target) == content(ROOT / 'hydra_actuator')


def test_version_is_the_same_everywhere():
    setup = (ROOT / 'setup.py').read_text()
    assert PACKAGE_XML.findtext('version') == hydra_actuator.__version__
    assert f"version='{hydra_actuator.__version__}'" in setup


def test_license_is_the_same_everywhere():
    assert PACKAGE_XML.findtext('license') == 'Apache-2.0'
    assert 'Apache License' in (ROOT / 'LICENSE').read_text()


def test_public_names_are_listed_before_they_are_loaded():
    assert set(hydra_actuator.__all__) <= set(dir(hydra_actuator))
    with pytest.raises(AttributeError, match='no attribute'):
        hydra_actuator.nonsense  # noqa: B018
