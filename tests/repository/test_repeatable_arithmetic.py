"""Functions that numpy rounds differently for views are called on contiguous arrays: see planar's cos_sin."""

import re
from pathlib import Path
from typing import Iterator

import structure

# Functions with a vectorized implementation that rounds differently from the one that numpy uses for a view,
# called on a column behind the first two, or on columns, such as ``np.cos(poses[:, 2])``.
TRIGONOMETRIC = "sin|cos|tan|arcsin|arccos|arctan|arctan2|sinh|cosh|tanh"
EXPONENTIAL = "exp|exp2|expm1|log|log2|log10|log1p|power"
CALL = re.compile(rf"np\.({TRIGONOMETRIC}|{EXPONENTIAL})\([\w.]+\[:, ?([2-9]|\d*:\d*)\]\)")


def calls_on_columns(path: Path) -> Iterator[int]:
    """Yield the lines of a module that call such a function on a column."""
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if CALL.search(line):
            yield number


def test_no_function_is_called_on_a_column():
    files = [*structure.modules(structure.ROOT), *(structure.ROOT / "src").glob("*/templates/*.py")]
    found = [
        f"{path.relative_to(structure.ROOT)}:{line}" for path in files for line in calls_on_columns(path)
    ]
    assert found == [], "use planar.geometry.pose.cos_sin, or a contiguous copy"


def test_a_call_on_a_column_is_found(tmp_path):
    lines = ["np.cos(poses[:, 2])", "np.cos(poses[:, 0])", "np.exp(logs)", "np.sin(a[:, 2:])"]
    (tmp_path / "module.py").write_text("\n".join(lines))
    assert list(calls_on_columns(tmp_path / "module.py")) == [1, 4]
