import json

import pytest

from run_report import RecordError
from run_report.comparison import ComparisonRow, compared_figures, comparison_html, load_run
from run_report.record import save_record


@pytest.fixture
def folders(record, result, tmp_path):
    for name, change in (("first", {}), ("second", {"success": False, "reason": "stuck", "seed": 8})):
        folder = tmp_path / name
        folder.mkdir()
        save_record(folder, record)
        (folder / "result.json").write_text(json.dumps({**result, **change}))
    return tmp_path / "first", tmp_path / "second"


def test_figures_stand_side_by_side_and_inputs_only_where_they_differ(folders):
    rows = compared_figures(*map(load_run, folders))
    assert rows[0] == ComparisonRow("outcome", "success", "failure: stuck")
    assert ComparisonRow("seed", "7", "8") in rows
    assert ComparisonRow("off pickup", "0.012 m", "0.012 m") in rows
    assert not [row for row in rows if row.name == "python"]


def test_the_page_shows_both_maps_and_both_lines(folders):
    page = comparison_html(*map(load_run, folders))
    assert page.count('<svg class="map"') == 2
    assert 'class="line a"' in page and 'class="line b"' in page


def test_a_folder_without_a_run_is_refused_by_name(tmp_path):
    with pytest.raises(RecordError, match="not the folder of a run"):
        load_run(tmp_path)
    (tmp_path / "result.json").write_text("{")
    with pytest.raises(RecordError, match="result.json: cannot be read"):
        load_run(tmp_path)
