# SPDX-License-Identifier: Apache-2.0
"""What cannot become a new directory is refused, and nothing is made on the way."""

import os

from hydra_actuator.cli.output import refuse_output
from hydra_actuator.errors import InputError
import pytest


def test_a_new_directory_is_accepted_and_not_made(tmp_path):
    refuse_output(str(tmp_path / 'new' / 'one'))
    assert not list(tmp_path.iterdir())


def test_an_empty_directory_is_accepted_only_where_it_may_be(tmp_path):
    refuse_output(str(tmp_path), may_be_empty=True)
    with pytest.raises(InputError, match='exists already'):
        refuse_output(str(tmp_path))


@pytest.mark.parametrize('may_be_empty', [False, True])
def test_what_holds_something_is_refused(tmp_path, may_be_empty):
    (tmp_path / '.hidden').touch()
    for output in (tmp_path, tmp_path / '.hidden'):
        with pytest.raises(InputError, match='nothing is overwritten'):
            refuse_output(str(output), may_be_empty)
    with pytest.raises(InputError, match='is not a directory'):
        refuse_output(str(tmp_path / '.hidden' / 'one'), may_be_empty)


def test_a_dangling_link_is_refused(tmp_path):
    link = tmp_path / 'link'
    link.symlink_to(tmp_path / 'nowhere')
    with pytest.raises(InputError, match='exists already'):
        refuse_output(str(link), may_be_empty=True)


def test_what_may_not_be_written_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(os, 'access', lambda path, mode: False)
    for output in (tmp_path, tmp_path / 'new'):
        with pytest.raises(InputError, match=f'{tmp_path} is not writable'):
            refuse_output(str(output), may_be_empty=True)
