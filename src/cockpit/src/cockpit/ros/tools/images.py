"""Images: the image of a camera topic (rqt_image_view)."""

from typing import Any, Optional

from cockpit.drawing import CameraImage
from cockpit.layers.pictures import LAYER
from cockpit.models.rates import RateMeter
from cockpit.ros.graph import TopicFeed
from cockpit.ros.tool import ToolContext

NONE = "(none)"


class ImagesTool:
    name, title, seconds = "images", "Images", 0.1

    def __init__(self, context: ToolContext):
        self._context = context
        self._feed: Optional[TopicFeed] = None
        self._rate = RateMeter()
        self._image: Any = None
        self._draw = LAYER.make()
        self._awaited = context.words[:1]

    def build(self) -> None:
        self._topic = self._context.gui.add_dropdown("Topic", (NONE,))
        self._status = self._context.gui.add_markdown("")
        self._space = self._context.gui.add_folder("Picture")

    def update(self, now: float) -> None:
        types = self._context.graph.topics()
        found = (NONE, *sorted(topic for topic, kind in types.items() if kind in LAYER.types))
        if self._topic.options != found:
            self._topic.options = found
        if self._awaited and self._awaited[0] in found:
            self._topic.value, self._awaited = self._awaited[0], ()
        self._subscribe()
        if self._feed is None:
            self._status.content = "choose a topic" if len(found) > 1 else "no topic has images"
            return
        hertz, _ = self._rate.update(now, self._feed.count, 0)
        for message in self._feed.messages():
            self._status.content = f"{message.width} x {message.height}, {message.encoding}, {hertz:.1f} Hz"
            for part in self._draw(message).parts:
                if isinstance(part.shape, CameraImage):
                    self._show(part.shape.picture)

    def pause(self) -> None:
        if self._feed is not None:
            self._feed.close()
            self._feed = None

    close = pause

    def _subscribe(self) -> None:
        wanted = self._topic.value
        if self._feed is not None and self._feed.topic != wanted:
            self.pause()
            if self._image is not None:
                self._image.remove()
                self._image = None
        if self._feed is None and wanted != NONE:
            self._feed, self._rate = self._context.graph.feed(wanted), RateMeter()

    def _show(self, picture: Any) -> None:
        if self._image is None:
            with self._space:
                self._image = self._context.gui.add_image(picture, jpeg_quality=75)
        else:
            self._image.image = picture


TOOL = ImagesTool
