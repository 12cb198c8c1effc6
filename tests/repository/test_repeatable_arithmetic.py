"""Functions that numpy rounds differently for views are called on contiguous arrays: see planar's cos_sin."""

import ast
from pathlib import Path
from typing import Iterator

import structure

# Functions with a vectorized implementation that rounds differently from the one that numpy uses for a view.
TRIGONOMETRIC = "sin cos tan arcsin arccos arctan arctan2 sinh cosh tanh"
EXPONENTIAL = "exp exp2 expm1 log log2 log10 log1p power"
FUNCTIONS = {f"np.{name}" for name in f"{TRIGONOMETRIC} {EXPONENTIAL}".split()}


def calls_on_columns(path: Path) -> Iterator[int]:
    """Yield the lines that call one of FUNCTIONS of numpy on a column, such as ``np.cos(poses[:, 2])``.

    The first two columns, and those of a row taken first, end before the array does.
    """
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if (
            isinstance(node, ast.Call)
            and ast.unparse(node.func) in FUNCTIONS
            and any(isinstance(each, ast.Subscript) and is_column(each.slice) for each in node.args)
        ):
            yield node.lineno


def is_column(index: ast.expr) -> bool:
    """Return whether an index selects a column behind the first two, or columns."""
    if not isinstance(index, ast.Tuple) or not isinstance(index.elts[0], ast.Slice):
        return False
    column = index.elts[-1]
    return isinstance(column, ast.Slice) or (isinstance(column, ast.Constant) and column.value > 1)


def test_no_function_is_called_on_a_column():
    files = [*structure.modules(structure.ROOT), *(structure.ROOT / "src").glob("*/templates/*.py")]
    found = [
        f"{path.relative_to(structure.ROOT)}:{line}" for path in files for line in calls_on_columns(path)
    ]
    assert found == [], "use planar.geometry.pose.cos_sin, or a contiguous copy"


def test_a_call_on_a_column_is_found(tmp_path):
    lines = ["np.cos(poses[:, 2])", "np.cos(poses[:, 0])", "np.exp(logs)", "np.arctan2(a[:, 3], a[:, 2])"]
    (tmp_path / "module.py").write_text("\n".join(lines))
    assert list(calls_on_columns(tmp_path / "module.py")) == [1, 4]
