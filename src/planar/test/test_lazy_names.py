"""Public names of a package are imported when they are first used."""

import subprocess
import sys

import pytest

from planar.lazy_names import lazy_names


@pytest.fixture
def package(tmp_path, monkeypatch):
    """A package whose module ``heavy`` has a public name, and the module's number of imports."""
    folder = tmp_path / "lazy_package"
    folder.mkdir()
    (folder / "__init__.py").write_text(
        "from planar.lazy_names import lazy_names\n"
        "__getattr__ = lazy_names(__name__, {'lazy_package.heavy': ('name',)}, {'old': 1}.__getitem__)\n"
    )
    (folder / "heavy.py").write_text("name = object()\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    yield __import__("lazy_package")
    for module in ("lazy_package", "lazy_package.heavy"):
        sys.modules.pop(module, None)


def test_a_module_is_imported_when_its_name_is_first_used(package):
    assert "lazy_package.heavy" not in sys.modules
    assert package.name is sys.modules["lazy_package.heavy"].name
    assert package.name is vars(package)["name"], "and not looked up again"


def test_other_names_are_resolved_elsewhere(package):
    assert package.old == 1


def test_an_unknown_name_is_no_attribute():
    with pytest.raises(AttributeError, match="module 'planar' has no attribute 'nonsense'"):
        lazy_names("planar", {})("nonsense")


def test_an_error_class_is_imported_without_numpy():
    program = "import sys; from planar import PlanarError; sys.exit('numpy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", program]).returncode == 0
