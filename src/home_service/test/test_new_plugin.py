"""A generated plugin package works without changes."""

import importlib
import runpy
import sys

import pytest

from home_service.commands.new_plugin import KINDS, NewPlugin
from planar import SettingsError


@pytest.mark.parametrize("kind", KINDS)
def test_a_generated_plugin_is_found_by_its_name_and_fulfils_its_contract(
    kind, tmp_path, monkeypatch, capsys
):
    assert NewPlugin(f"my_{kind}", kind, tmp_path).run() == 0
    monkeypatch.syspath_prepend(str(tmp_path / f"my_{kind}/src"))
    assert f"my_{kind}.{kind}/My{kind.title().replace('_', '')}" in capsys.readouterr().out
    test = runpy.run_path(str(tmp_path / f"my_{kind}/test/test_my_{kind}.py"))
    assert test["SUITE"].checks
    for check in test["SUITE"].checks:
        test["test_it_keeps_its_contract"](check)
    del sys.modules[f"my_{kind}"]
    importlib.invalidate_caches()


@pytest.mark.parametrize("package", ["amcl_lite", "laboratory", "move_base_lite", "sim_bridge", "slam_lite"])
def test_tests_of_plugins_that_were_generated_before_find_their_checks(package):
    checks = importlib.import_module(f"{package}.check")
    with pytest.warns(DeprecationWarning, match="KITS is deprecated; use .*CHECK_SUITES"):
        assert checks.KITS is checks.CHECK_SUITES


@pytest.mark.parametrize("kind", KINDS)
def test_a_generated_plugin_has_its_own_names(kind, tmp_path):
    NewPlugin("mine", kind, tmp_path).run()
    code = (tmp_path / f"mine/src/mine/{kind}.py").read_text()
    assert "class Mine" in code
    assert not any(
        name in code for name in ("CLASS", "TITLE", KINDS[kind].example.rpartition("/")[2] or "CLASS")
    )


@pytest.mark.parametrize("name", ["My Planner", "2fast", "planner-1"])
def test_an_invalid_package_name_is_refused(name, tmp_path):
    with pytest.raises(SettingsError, match="is no package name"):
        NewPlugin(name, "local_planner", tmp_path).run()
    assert not list(tmp_path.iterdir())


def test_nothing_is_overwritten(tmp_path):
    NewPlugin("mine", "local_planner", tmp_path).run()
    with pytest.raises(SettingsError, match="exists already"):
        NewPlugin("mine", "local_planner", tmp_path).run()
