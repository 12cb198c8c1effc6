"""Messages that are passed on without being deserialized, byte for byte."""

from io import BytesIO
from typing import Any, ClassVar

import genpy

from planar_ros.messages.validation import MessageError


class RawMessage:
    """The bytes of a message, with the sequence number of its first publisher.

    Attributes:
        kind: Type of the message.
        data: Its serialized bytes.
    """

    kind: ClassVar[Any]
    data = b""

    @classmethod
    def from_message(cls, message: genpy.Message) -> "RawMessage":
        """Serialize a message."""
        buffer, raw = BytesIO(), cls()
        message.serialize(buffer)
        raw.data = buffer.getvalue()
        return raw

    def decode(self) -> Any:
        """Deserialize the message.

        Raises:
            MessageError: Its bytes are invalid.
        """
        try:
            return self.kind().deserialize(self.data)
        except (genpy.DeserializationError, ValueError) as error:  # ValueError: an array is cut short
            raise MessageError(f"it cannot be read ({error})") from None

    def serialize(self, buff) -> None:
        buff.write(self.data)

    def deserialize(self, data: bytes) -> "RawMessage":
        self.data = data
        return self


def raw_type(kind: type) -> Any:
    """Make a type to publish and subscribe messages of a kind as RawMessage."""
    return type(f"Raw{kind.__name__}", (RawMessage, kind), {"kind": kind})
