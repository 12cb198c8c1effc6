"""Map files of a checkout."""

import re
from pathlib import Path
from typing import List

from run_project.checkout.layout import Checkout

_IMAGE = re.compile(r"^image:\s*[\"']?([^\s\"']+)", re.MULTILINE)
_RESOLUTION = re.compile(r"^resolution:", re.MULTILINE)


def maps_without_image(checkout: Checkout) -> List[str]:
    """Maps that name an image which is nowhere in the checkout, and that name: map_server refuses them."""
    names = {Path(file).name for file in checkout.files}
    found = []
    for file in checkout.files:
        path = checkout.root / file
        if path.suffix not in (".yaml", ".yml") or not path.is_file():
            continue
        text = path.read_text(errors="replace")
        image = _IMAGE.search(text)
        if image and _RESOLUTION.search(text) and Path(image.group(1)).name not in names:
            found.append(f"{file} ({image.group(1)})")
    return found
