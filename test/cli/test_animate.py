# SPDX-License-Identifier: Apache-2.0
"""`animate`: bad input is one line."""

from hydra_actuator.cli.main import main
import pytest


@pytest.mark.parametrize('arguments, culprit', [
    (['-o', 'a.avi'], '.gif, .mp4, .html'), (['-o', 'nowhere/a.gif'], 'no directory'),
    (['-o', 'a.gif', '--frames', '1'], '--frames 1'), (['-o', 'a.gif', '--fps', '0'], '--fps 0'),
    (['-o', 'a.gif', '--dpi', '1'], '--dpi 1'), (['-o', 'a.gif'], 'nowhere'),
])
def test_bad_input_is_one_line_and_exit_code_2(tmp_path, monkeypatch, capsys, arguments, culprit):
    monkeypatch.chdir(tmp_path)
    assert main(['animate', 'nowhere', *arguments]) == 2
    message = capsys.readouterr().err
    assert message.count('\n') == 1
    assert culprit in message
