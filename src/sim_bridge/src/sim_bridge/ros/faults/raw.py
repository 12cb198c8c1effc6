"""Messages that are handed on as they came, to the last bit."""

from io import BytesIO
from typing import Any, ClassVar

import genpy

from planar_ros.messages.border import MessageError


class RawMessage:
    """Of a ``kind`` on the wire, but only its bytes, with the number that its first sender gave it."""

    kind: ClassVar[Any]
    data = b""

    @classmethod
    def of(cls, message: genpy.Message) -> "RawMessage":
        buffer, made = BytesIO(), cls()
        message.serialize(buffer)
        made.data = buffer.getvalue()
        return made

    def read(self) -> Any:
        """The message itself. Raises MessageError if the bytes are none."""
        try:
            return self.kind().deserialize(self.data)
        except (genpy.DeserializationError, ValueError) as error:  # the latter: arrays cut short
            raise MessageError(f"it cannot be read ({error})") from None

    def serialize(self, buff) -> None:
        buff.write(self.data)

    def deserialize(self, data: bytes) -> "RawMessage":
        self.data = data
        return self


def raw(kind: type) -> Any:
    """The messages of a kind, to publish and to subscribe to, as RawMessage."""
    return type(f"Raw{kind.__name__}", (RawMessage, kind), {"kind": kind})
