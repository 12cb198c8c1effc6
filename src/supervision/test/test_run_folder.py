import json
from pathlib import Path

import pytest

from planar import SettingsError
from supervision.run_folder import create_run_folder, write_result


def test_two_runs_in_one_second_get_separate_folders(tmp_path):
    folders = {create_run_folder(tmp_path / "runs", "errand") for _ in range(3)}
    assert len(folders) == 3
    assert all((folder / "log").is_dir() for folder in folders)


def test_a_name_taken_by_another_run_at_the_same_moment_is_skipped(tmp_path, monkeypatch):
    create_run_folder(tmp_path, "errand")
    monkeypatch.setattr(Path, "exists", lambda _path: False)
    folders = {create_run_folder(tmp_path, "errand") for _ in range(3)}
    assert len(folders) == 3


def test_a_place_where_no_folder_can_be_made_is_named(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(SettingsError, match="file/runs: no run folder can be made there"):
        create_run_folder(tmp_path / "file/runs", "errand")


def test_a_result_is_json(tmp_path):
    assert json.loads(write_result(tmp_path, {"success": True}).read_text()) == {"success": True}
