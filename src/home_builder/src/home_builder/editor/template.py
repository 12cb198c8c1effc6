"""The picture that is traced: kept in the folder of the home, beside the plan that refers to it."""

import hashlib
import io
import re
from dataclasses import replace
from pathlib import Path
from typing import Tuple

from home_builder.errors import EditorError
from home_builder.imports.pictures import MAX_PIXELS, import_picture
from home_builder.plan.frames import shifted
from home_builder.plan.model import HomePlan, Template
from planar import write_atomically

MAX_BYTES = 32 << 20
# Width at which a picture without a scale is shown [m].
FIRST_WIDTH = 10.0
KINDS = {"PNG": "png", "JPEG": "jpg", "GIF": "gif", "WEBP": "webp", "BMP": "bmp"}
MEDIA = {suffix: f"image/{'jpeg' if suffix == 'jpg' else suffix}" for suffix in KINDS.values()}
# Tag of EXIF, and the first of its values that exchanges width and height.
ORIENTATION, LYING = 0x0112, 5
NAME = re.compile(r"template_[0-9a-f]{12}\.(?:" + "|".join(MEDIA) + r")")


def save_template(folder: Path, content: bytes) -> Template:
    """Save a picture in the folder of a home.

    Args:
        folder: The folder.
        content: File of the picture.

    Returns:
        The template, with a width of 10 m until its scale is set.

    Raises:
        EditorError: The content is no picture that browsers show, or it is too large.
        FileWriteError: It cannot be saved.
    """
    kind, width, height = _kind_and_size(content)
    name = f"template_{hashlib.sha256(content).hexdigest()[:12]}.{kind}"
    write_atomically(folder / name, content)
    return Template(name, 0.0, 0.0, FIRST_WIDTH / width, width, height)


def _kind_and_size(content: bytes) -> Tuple[str, int, int]:
    """Return suffix, width and height of a picture, upright by its EXIF data. Raises EditorError."""
    from PIL import Image

    Image.MAX_IMAGE_PIXELS = None  # the limit here is stated in the message
    try:
        with Image.open(io.BytesIO(content)) as image:
            kind, (width, height) = KINDS.get(image.format or ""), image.size
            if image.getexif().get(ORIENTATION, 1) >= LYING:
                width, height = height, width
        if width * height <= MAX_PIXELS:
            with Image.open(io.BytesIO(content)) as image:  # again, as nothing may be read before this check
                image.verify()
    except Exception as error:  # errors of Pillow's readers have no common class
        reason = "unknown format" if "cannot identify" in str(error) else str(error)
        raise EditorError(f"the template is not a readable picture ({reason})") from None
    if width * height > MAX_PIXELS:
        most = f"{MAX_PIXELS // 1_000_000} million"
        raise EditorError(f"the template has {width} x {height} pixels, more than {most}; reduce the picture")
    if kind is None:
        raise EditorError(f"the template must be one of {', '.join(KINDS)}; convert the picture")
    return kind, width, height


def read_template(folder: Path, name: str) -> bytes:
    """Return the file of a template.

    Raises:
        EditorError: There is none of that name.
    """
    path = folder / name
    if NAME.fullmatch(name) is None or not path.is_file():
        raise EditorError(f"{path}: the template is missing; choose the picture again")
    return path.read_bytes()


def remove_unused_templates(folder: Path, plan: HomePlan) -> None:
    """Remove the pictures of earlier sessions that the plan does not use."""
    used = None if plan.template is None else plan.template.file
    for path in folder.glob("template_*"):
        if path.name != used and NAME.fullmatch(path.name):
            path.unlink()


def traced(folder: Path, template: Template) -> HomePlan:
    """Return the walls and the furniture that a template shows, where it lies in the drawing.

    Args:
        folder: Folder of the home.
        template: Picture with its scale.

    Raises:
        PlanarError: The picture is missing or shows no plan.
    """
    read_template(folder, template.file)  # states that it is missing
    plan = import_picture(folder / template.file, template.scale)
    return replace(shifted(plan, template.x, template.y), name=folder.name)
