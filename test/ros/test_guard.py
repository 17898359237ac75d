# SPDX-License-Identifier: Apache-2.0
"""Exceptions in transitions and services of a real node: logged, answered, survived."""

from hydra_actuator.ros.guard import answered, guard_services, transition
from lifecycle_msgs.srv import ChangeState, GetState
import pytest
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import ParameterValue
from rcl_interfaces.srv import SetParameters, SetParametersAtomically
import rclpy
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn
from rclpy.parameter import Parameter
from std_srvs.srv import Trigger

SUCCESS, FAILURE, ERROR = (
    TransitionCallbackReturn.SUCCESS, TransitionCallbackReturn.FAILURE,
    TransitionCallbackReturn.ERROR)


class Fragile(LifecycleNode):
    """A node whose transition `breaks` raises, as does its service."""

    def __init__(self, **settings):
        super().__init__('fragile', **settings)
        self.breaks = self.problem = ''
        guard_services(self)
        self.create_service(Trigger, '~/ask', answered(self, 'ask', self._ask))

    def _ask(self, request, response):
        raise KeyError('asked')

    def _pass(self, name):
        if self.breaks == name:
            raise RuntimeError(name)
        return SUCCESS

    @transition(FAILURE)
    def on_configure(self, state):
        return self._pass('configure')

    @transition(ERROR)
    def on_activate(self, state):
        return self._pass('activate')

    @transition(ERROR)
    def on_deactivate(self, state):
        return self._pass('deactivate')

    @transition(ERROR)
    def on_cleanup(self, state):
        return self._pass('cleanup')

    @transition(FAILURE)
    def on_error(self, state):
        return SUCCESS


@pytest.fixture
def fragile(domain, peer):
    """Spin a fragile node in the peer's executor."""
    node = Fragile(context=peer.node.context)
    peer._executor.add_node(node)
    yield node
    peer._executor.remove_node(node)
    node.destroy_node()


def change(peer, label):
    request = ChangeState.Request()
    request.transition.label = label
    answer = peer.call(ChangeState, '/fragile/change_state', transition=request.transition)
    return answer.success, peer.call(GetState, '/fragile/get_state').current_state.label


def test_a_raising_transition_is_answered_and_leaves_a_state_to_go_on_from(peer, fragile):
    for way in (['configure'], ['configure', 'activate'],
                ['configure', 'activate', 'deactivate'], ['configure', 'cleanup']):
        fragile.breaks = breaks = way[-1]
        answers = [change(peer, label) for label in way]
        assert all(done for done, _ in answers[:-1])
        assert answers[-1] == (False, 'unconfigured')
        assert fragile.problem == f"on_{breaks}: RuntimeError('{breaks}')"


def test_an_invalid_transition_is_answered_in_every_state(peer, fragile):
    for way, invalid in (
        (None, ('activate', 'deactivate', 'cleanup', 'no_such')),
        ('configure', ('configure', 'deactivate')),
        ('activate', ('configure', 'activate', 'cleanup')),
        ('shutdown', ('configure', 'activate', 'cleanup', 'shutdown')),
    ):
        if way:
            assert change(peer, way)[0]
        before = peer.call(GetState, '/fragile/get_state').current_state.label
        for label in invalid:
            assert change(peer, label) == (False, before)


def test_a_raising_service_is_answered_with_its_reason(peer, fragile):
    answer = peer.call(Trigger, '/fragile/ask')
    assert (answer.success, answer.message) == (False, "KeyError('asked')")
    assert rclpy.ok(context=peer.node.context)


def test_a_parameter_of_a_type_that_is_none_is_refused(peer, fragile):
    fragile.declare_parameter('known', 1.0)
    strange = ParameterMessage(name='known', value=ParameterValue(type=99))
    good = Parameter('known', value=2.0).to_parameter_msg()
    answer = peer.call(
        SetParametersAtomically, '/fragile/set_parameters_atomically', parameters=[good, strange])
    assert not answer.result.successful
    assert '99' in answer.result.reason
    assert fragile.get_parameter('known').value == 1.0
    answer = peer.call(SetParameters, '/fragile/set_parameters', parameters=[good, strange, good])
    assert [one.successful for one in answer.results] == [True, False, False]
    assert fragile.get_parameter('known').value == 2.0
