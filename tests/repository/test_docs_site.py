"""The documentation's site: its navigation, what its search finds, and the commands of its tutorials."""

import re
import runpy
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace
from xml.etree import ElementTree

import pytest
import yaml

ROOT = Path(__file__).resolve().parents[2]
SITE = yaml.safe_load((ROOT / "mkdocs.yml").read_text())
PAGE = '<p>Text</p><div class="{} highlight"><pre><code>code()</code></pre></div>'


@pytest.fixture(scope="module")
def hooks():
    return SimpleNamespace(**runpy.run_path(str(ROOT / "docs/hooks.py")))


def pages_in(entry):
    if isinstance(entry, str):
        return [entry]
    return [
        page for part in (entry.values() if isinstance(entry, dict) else entry) for page in pages_in(part)
    ]


def test_the_navigation_leads_by_kind_of_page_to_every_page():
    titles = [next(iter(entry)) for entry in SITE["nav"] if isinstance(entry, dict)]
    assert titles == ["Get started", "How-to", "Reference", "Explanation", "Reports"]
    written = {str(path.relative_to(ROOT / "docs")) for path in ROOT.glob("docs/**/*.md")}
    assert set(pages_in(SITE["nav"])) == written


def test_every_picture_is_shown_and_can_be_taken_again():
    texts = [path.read_text() for path in [ROOT / "README.md", *ROOT.glob("docs/**/*.md")]]
    shown = {name for text in texts for name in re.findall(r"\]\(\S*images/([\w.]+)\)", text)}
    assert {path.name for path in ROOT.glob("docs/images/*")} == shown
    listed = subprocess.run(
        [sys.executable, ROOT / "docs/take_pictures.py", "none.png"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert set(re.findall(r"\w+\.(?:png|gif)", listed.stderr)) == {*shown, "none.png"}


@pytest.mark.parametrize("kind", ["doc-signature", "language-bash"])
def test_the_search_shows_no_code(hooks, kind):
    page = SimpleNamespace(file=SimpleNamespace(src_uri="how_to/write_a_plugin.md"))
    html = hooks.on_page_content(PAGE.format(kind), page=page)
    assert f'<div class="{kind} highlight" data-search-exclude><pre>' in html


def test_the_search_finds_the_options_of_scripts(hooks):
    page = SimpleNamespace(file=SimpleNamespace(src_uri="reference/scripts.md"))
    assert hooks.on_page_content(PAGE.format("language-text"), page=page) == PAGE.format("language-text")


def test_classes_show_the_signatures_of_their_constructors():
    (plugin,) = (plugin["mkdocstrings"] for plugin in SITE["plugins"] if "mkdocstrings" in plugin)
    assert plugin["handlers"]["python"]["options"]["merge_init_into_class"] is True


def test_the_crate_of_the_tutorial_can_be_touched_and_seen(tmp_path):
    blocks = (ROOT / "docs/get_started/own_home.md").read_text().split("```bash\n")[1:]
    (command,) = (block.split("```")[0] for block in blocks if "my.world" in block and "sed" in block)
    (tmp_path / "map").mkdir()
    (tmp_path / "map/home.world").write_text((ROOT / "map/home.world").read_text())
    subprocess.run(["bash", "-c", command], cwd=tmp_path, check=True)
    crate = ElementTree.parse(tmp_path / "my.world").find("world/model[@name='crate']")
    assert crate is not None
    sizes = [crate.findtext(f"link/{kind}/geometry/box/size") for kind in ("collision", "visual")]
    assert sizes == ["0.5 0.4 0.6"] * 2
