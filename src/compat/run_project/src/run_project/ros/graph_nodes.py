"""Names and process numbers of the nodes in the graph."""

from typing import Callable, Dict, FrozenSet, Iterable, Optional

# Questions to a node that does not answer.
ATTEMPTS = 3


class GraphNodes:
    """Asks each new node of the graph once for its process.

    Args:
        ask: Returns the process of a node, or None if it does not answer.
    """

    def __init__(self, ask: Callable[[str], Optional[int]]):
        self._ask = ask
        self._pids: Dict[str, Optional[int]] = {}
        self._attempts: Dict[str, int] = {}

    @property
    def names(self) -> FrozenSet[str]:
        """Names of the nodes, without namespace."""
        return frozenset(name.rpartition("/")[2] for name in self._attempts)

    @property
    def pids(self) -> FrozenSet[int]:
        """Processes of the nodes."""
        return frozenset(pid for pid in self._pids.values() if pid is not None)

    def update(self, names: Iterable[str]) -> None:
        """Take the names of all nodes, and ask those that are new or have not answered yet."""
        present = set(names)
        for gone in self._attempts.keys() - present:
            self._pids.pop(gone, None)
            del self._attempts[gone]
        for name in sorted(present):
            attempts = self._attempts.setdefault(name, 0)
            if self._pids.get(name) is None and attempts < ATTEMPTS:
                self._attempts[name] += 1
                self._pids[name] = self._ask(name)
