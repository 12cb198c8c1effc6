"""Errors of independent parts of a file, reported together."""

from typing import Any, Callable, Iterable, List, Optional, Tuple, TypeVar

from planar.errors import PlanarError

Part = TypeVar("Part")
Item = TypeVar("Item")


class ErrorList:
    """Collects errors, so that a file with several mistakes need not be read several times."""

    def __init__(self) -> None:
        self._errors: List[PlanarError] = []

    def read(self, reader: Callable[..., Part], *arguments: Any) -> Optional[Part]:
        """Return what a function returns; None if it raises a PlanarError, which is collected."""
        try:
            return reader(*arguments)
        except PlanarError as error:
            self._errors.append(error)
            return None

    def raise_all(self) -> None:
        """Raise one error with the texts of all, one a line, of the class of the first one.

        Raises:
            PlanarError: If an error was collected.
        """
        if self._errors:
            raise type(self._errors[0])("\n".join(dict.fromkeys(map(str, self._errors)))) from None


def read_each(reader: Callable[[Item], Part], items: Iterable[Item]) -> Tuple[Part, ...]:
    """Return what a function returns for each item.

    Raises:
        PlanarError: With the errors of all items.
    """
    errors = ErrorList()
    parts = [errors.read(reader, item) for item in items]
    errors.raise_all()
    return tuple(part for part in parts if part is not None)
