"""YAML whose parsing takes bounded time and memory, whatever the text."""

from typing import Any, Dict

import yaml

# Size of a text, and of its value with all aliases expanded, as readers and messages see it. A node counts as
# so many characters besides its own.
MAX_BYTES, MAX_EXPANDED_SIZE, NODE_SIZE = 1 << 20, 2 << 20, 16
# Nesting of tables and lists; parsing is recursive.
MAX_DEPTH = 100
# Converting digits takes time that grows with the square of their number.
MAX_NUMBER_LENGTH = 400
TAG = "tag:yaml.org,2002:"
_NUMBERS = (f"{TAG}int", f"{TAG}float")


class BoundedLoader(yaml.SafeLoader):
    """SafeLoader that refuses texts that merge keys or aliases make huge, cyclic ones, and long numbers."""

    def __init__(self, text: str):
        super().__init__(text)
        self._depth, self._size = 0, 0
        # Size with all aliases expanded of each finished node, by its id.
        self._sizes: Dict[int, int] = {}

    def compose_node(self, parent: Any, index: Any) -> Any:
        mark, is_alias = self.peek_event().start_mark, self.check_event(yaml.AliasEvent)
        before, self._depth = self._size, self._depth + 1
        if self._depth > MAX_DEPTH:
            raise _error("nested too deeply", mark)
        node = super().compose_node(parent, index)
        self._depth -= 1
        if is_alias and id(node) not in self._sizes:
            raise _error("found an alias of what contains it", mark)
        if is_alias:
            self._size += self._sizes[id(node)]
        else:
            self._size += NODE_SIZE + (len(node.value) if isinstance(node, yaml.ScalarNode) else 0)
            self._sizes[id(node)] = self._size - before
        if self._size > MAX_EXPANDED_SIZE:
            raise _error(f"larger than {MAX_EXPANDED_SIZE >> 20} MB with all aliases", mark)
        return node

    def construct_scalar(self, node: Any) -> Any:
        if node.tag in _NUMBERS and len(node.value) > MAX_NUMBER_LENGTH:
            raise _error(f"number of more than {MAX_NUMBER_LENGTH} characters", node.start_mark)
        return super().construct_scalar(node)


def load_yaml(text: str) -> Any:
    """Parse a YAML text with the types of yaml.safe_load.

    Raises:
        yaml.YAMLError: It is not valid, or its value would be too large.
        ValueError: It is too long, or a date in it does not exist.
    """
    check_length(text)
    loader = BoundedLoader(text)
    try:
        return loader.get_single_data()
    finally:
        loader.dispose()


def check_length(text: str) -> None:
    """Raise a ValueError if a text is too long to be parsed."""
    if len(text) > MAX_BYTES:
        raise ValueError(f"larger than {MAX_BYTES >> 20} MB")


def _error(problem: str, mark: Any) -> yaml.constructor.ConstructorError:
    return yaml.constructor.ConstructorError(None, None, problem, mark)
