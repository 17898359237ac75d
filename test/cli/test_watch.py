# SPDX-License-Identifier: Apache-2.0
"""`watch`: what it refuses in one line."""

from hydra_actuator.cli.main import main
import pytest


@pytest.mark.parametrize('arguments, culprit', [
    (['--rate', '0'], '--rate 0'), (['--rate', 'nan'], '--rate nan'),
    (['actuator'], 'begins with a /'), ([], 'needs a terminal')])
def test_bad_input_is_one_line_and_exit_code_2(capsys, arguments, culprit):
    assert main(['watch', *arguments]) == 2
    message = capsys.readouterr().err
    assert message.count('\n') == 1
    assert culprit in message
