"""How a check fails."""

from contextlib import contextmanager
from typing import Iterator, Type


class CheckFailed(Exception):  # noqa: N818  -- it is the plugin that has erred
    """A plugin does not do what its contract says; the text is what it does."""


def expect(is_so: bool, text: str) -> None:
    if not is_so:
        raise CheckFailed(text)


@contextmanager
def expect_refusal(kind: Type[Exception], text: str) -> Iterator[None]:
    """What is inside has to raise ``kind``."""
    try:
        yield
    except kind:
        return
    raise CheckFailed(text)
