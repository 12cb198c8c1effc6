"""Malformed records and results are refused."""

import json

import pytest

from run_report import RecordError
from run_report.comparison import load_run
from run_report.record import FILE_NAME, load_record, save_record

CHANGES = {
    "stamps that are texts": {"states": [["x", "y"]]},
    "stamps that are nothing": {"goals": [[None, 1.0, 1.0, 1.0]]},
    "names that are numbers": {"collisions": [[1.0, 7]]},
    "numbers that are lists": {"goals": [[1.0, [], 1.0, 1.0]]},
    "numbers that are infinite": {"goals": [[1.0, float("inf"), 1.0, 1.0]]},
    "numbers of 400 digits": {"truth": [[10**400, 0, 0, 0]]},
    "plans that are none": {"plans": 5},
    "a grid that is no picture": {"grid": {"png": "AAAA", "resolution": 0.1, "origin": [0, 0, 0]}},
    "a grid without cells": {"grid": {}},
    "a grid that is a list": {"grid": [1]},
}


@pytest.mark.parametrize("what", CHANGES)
def test_a_record_with_wrong_types_is_refused(record, tmp_path, what):
    path = save_record(tmp_path, record)
    path.write_text(json.dumps({**json.loads(path.read_text()), **CHANGES[what]}))
    with pytest.raises(RecordError, match=FILE_NAME):
        load_record(tmp_path)


@pytest.mark.parametrize(
    "content",
    ["[]", "7", "{", "[" * 100_000, '{"plans": 1' + 5000 * "0" + "}"],
    ids=["list", "number", "half", "deep", "long"],
)
def test_a_file_that_is_no_record_is_refused(tmp_path, content):
    (tmp_path / FILE_NAME).write_text(content)
    with pytest.raises(RecordError):
        load_record(tmp_path)


@pytest.mark.parametrize("change", [{"position_error": 5}, {"versions": []}, {"simulated_seconds": "long"}])
def test_a_result_with_wrong_types_is_refused(record, result, tmp_path, change):
    save_record(tmp_path, record)
    (tmp_path / "result.json").write_text(json.dumps({**result, **change}))
    with pytest.raises(RecordError, match="result"):
        load_run(tmp_path)
