# SPDX-License-Identifier: Apache-2.0
"""
Who commands: the nodes that publish on the command topics, and whether several move the valve.

The last accepted message of any command topic wins, so two controllers at once make a valve that
obeys neither. A message does not say who sent it: as rivals count all nodes that publish on the
valve's topics on which something came of late.
"""

from collections.abc import Callable, Mapping
import time

# The graph is asked this often [s].
INTERVAL = 1.0

# Return the fully qualified names of the nodes that publish on a topic.
Publishers = Callable[[str], list[str]]


class Commanders:
    """
    Knows the publishers of command topics.

    topics: full name by label; taken: messages so far by label, growing; `load` is the label
    of the topic that does not move the valve.
    """

    def __init__(
        self, topics: Mapping[str, str], taken: Mapping[str, int], load: str,
        publishers: Publishers, clock: Callable[[], float] = time.monotonic,
    ):
        self.names: dict[str, tuple[str, ...]] = {}
        self.rivals: tuple[str, ...] = ()
        self._topics = topics
        self._taken = taken
        self._load = load
        self._publishers = publishers
        self._clock = clock
        self._known: dict[str, int] = {}
        self._looked = float('-inf')

    def look(self) -> None:
        """Ask the graph, if the last time is long enough ago."""
        if self._clock() - self._looked < INTERVAL:
            return
        self._looked = self._clock()
        self.names = {
            label: tuple(sorted(self._publishers(topic)))
            for label, topic in self._topics.items()}
        rivals = set()
        for label, names in self.names.items():
            taken = self._taken.get(label, 0)
            if taken > self._known.get(label, 0) and label != self._load:
                rivals.update(names)
            self._known[label] = taken
        self.rivals = tuple(sorted(rivals)) if len(rivals) > 1 else ()


def publishers_of(node) -> Publishers:
    """Return a function that names a topic's publishers as the node's graph knows them."""
    def names(topic: str) -> list[str]:
        return [
            f'{one.node_namespace.rstrip("/")}/{one.node_name}'
            for one in node.get_publishers_info_by_topic(topic)]
    return names
