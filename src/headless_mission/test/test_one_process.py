"""The example of the page about one process works as printed."""

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
PAGE = ROOT / "docs/how_to/use_without_ros.md"


def test_the_page_drives_the_robot_to_its_goal():
    code = PAGE.read_text(encoding="utf-8").split("```python\n")[1].split("```")[0]
    path = os.pathsep.join(str(folder) for folder in ROOT.glob("src/*/src"))
    ran = subprocess.run(
        [sys.executable, "-c", code],
        cwd=ROOT,
        env={**os.environ, "PYTHONPATH": path},
        capture_output=True,
        text=True,
        timeout=200.0,
    )
    assert ran.returncode == 0, ran.stderr
    assert ran.stdout.startswith("Goal reached."), ran.stdout
