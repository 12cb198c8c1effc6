"""A page without a browser: its web socket and the messages it receives."""

import threading
from contextlib import suppress
from urllib.parse import urlsplit

import msgspec.msgpack
import viser
import zstandard
from waiting import wait_until
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect
from websockets.typing import Subprotocol

OPEN_SECONDS = 30.0
HOLD_HZ = 10.0
CAMERA = {
    "type": "ViewerCameraMessage",
    "wxyz": [1.0, 0.0, 0.0, 0.0],
    "position": [0.0, 0.0, 5.0],
    "fov": 1.0,
    "near": 0.1,
    "far": 100.0,
    "image_height": 600,
    "image_width": 800,
    "look_at": [0.0, 0.0, 0.0],
    "up_direction": [0.0, 0.0, 1.0],
}


def open_page(url, origin=None):
    """Open the web socket of a page that claims to come from ``origin``.

    Raises InvalidHandshake if the connection is rejected.
    """
    site, _, token = url.partition("/?token=")
    socket = connect(
        site.replace("http", "ws") + "/",
        origin=origin or site,
        additional_headers={"Cookie": f"cockpit_{urlsplit(site).port}={token}"},
        subprotocols=[Subprotocol(f"viser-v{viser.__version__}")],
        max_size=None,
        open_timeout=OPEN_SECONDS,
        close_timeout=0.2,
    )
    socket.send(msgspec.msgpack.encode(CAMERA))
    return socket


class PageClient:
    """A client of the cockpit.

    Attributes:
        notifications: Notifications received.
        controls: Id of each control by its label.
        texts: HTML of each panel by its id.
        nodes: Paths of the nodes of the scene.
        pictures: Number of updates received.
    """

    def __init__(self, url, origin=None):
        """Connect; see ``open_page``."""
        self._socket = open_page(url, origin)
        self.protocol = self._socket.subprotocol
        self.notifications, self.controls, self.texts, self.nodes = [], {}, {}, set()
        self._options = {}
        self.pictures = 0
        self.is_open = True
        threading.Thread(target=self._read, daemon=True).start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        self._socket.close()

    def send(self, message):
        """Send a message, or raw bytes or text."""
        is_raw = isinstance(message, (bytes, str))
        self._socket.send(message if is_raw else msgspec.msgpack.encode(message))

    def press(self, label):
        """Send the message that a page repeats while a button is held."""
        self.send({"type": "GuiButtonHoldMessage", "uuid": self.control(label), "frequency": HOLD_HZ})

    def set(self, label, value):
        message = {"type": "GuiUpdateMessage", "uuid": self.control(label), "updates": {"value": value}}
        self.send(message)

    def control(self, label):
        wait_until(f"a control {label}", lambda: label in self.controls, OPEN_SECONDS)
        return self.controls[label]

    def options(self, label):
        """Return the options of a list."""
        return self._options[self.control(label)]

    def wait_for_pictures(self, count=10):
        """Wait for more updates."""
        before = self.pictures
        wait_until("pictures", lambda: self.pictures >= before + count)

    def wait_for_notification(self, text):
        wait_until(f"a notification {text}", lambda: any(text in each for each in list(self.notifications)))

    def wait_for_text(self, text):
        wait_until(f"{text} on the page", lambda: any(text in each for each in list(self.texts.values())))

    def wait_until_closed(self):
        wait_until("the end of the connection", lambda: not self.is_open)

    def _read(self):
        with suppress(ConnectionClosed):
            for content in self._socket:
                for message in _messages_in(content):
                    self._handle(message)
                self.pictures += 1
        self.is_open = False

    def _handle(self, message):
        kind, props = message["type"], message.get("props") or {}
        if kind == "NotificationShowMessage":
            self.notifications.append(props["body"])
        elif kind.startswith("Gui") and "label" in props:
            self.controls[props["label"]] = message["uuid"]
        elif kind == "RemoveSceneNodeMessage":
            self.nodes.discard(message["name"])
        elif "name" in message and "props" in message:
            self.nodes.add(message["name"])
        changed = props or message.get("updates") or {}
        if isinstance(changed.get("content"), str):
            self.texts[message["uuid"]] = changed["content"]
        if "options" in changed:
            self._options[message["uuid"]] = changed["options"]


def _messages_in(content):
    """Decode an update: length of the messages, their packed length, the packed messages, then arrays."""
    size, packed = (int.from_bytes(content[at : at + 8], "little") for at in (0, 8))
    inner = zstandard.decompress(content[16 : 16 + packed], max_output_size=size)
    return msgspec.msgpack.decode(inner)["messages"]
