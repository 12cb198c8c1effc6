import re
from html.parser import HTMLParser

import numpy as np
import pytest
from PIL import Image

from planar import FileWriteError
from run_report import RecordError, RunRecord, load_record, summary, write_report, writing
from run_report.charts import nice_ticks, timeline
from run_report.figures import localization_errors, real_time_factors
from run_report.page import report_html
from run_report.picture import run_frames, run_picture
from run_report.record import EVENTS, SERIES, StateEvent, save_record

VOID = {"meta", "link", "input", "br"}
FILES = ["record.json", "report.html", "run.gif", "run.png"]
FILES += [f"trajectory_{name}.tum" for name in ("estimated", "odometry", "true")]


class Page(HTMLParser):
    """Checks that every element is closed in its turn, and keeps what a browser would load."""

    def __init__(self, text):
        super().__init__()
        self.open, self.loaded, self.text = [], [], ""
        self.feed(text)
        assert not self.open

    def handle_starttag(self, tag, attributes):
        if tag not in VOID:
            self.open.append(tag)
        self.loaded += [value for name, value in attributes if name in ("src", "href", "xlink:href")]

    def handle_startendtag(self, tag, attributes):
        self.handle_starttag(tag, attributes)
        self.open.pop()

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.text += data


def test_the_page_is_whole_and_loads_nothing(record, result):
    page = Page(report_html(result, record))
    assert page.loaded and all(address.startswith("data:") for address in page.loaded)
    assert "no <scan> & no map" in page.text
    assert "0.012 m" in page.text
    assert "picking up <now>" in page.text


def test_a_page_with_only_a_verdict_can_be_made():
    page = Page(report_html({"success": False, "reason": "no master"}, RunRecord()))
    assert "no master" in page.text


def test_every_sample_and_event_survives_being_saved(record, tmp_path):
    save_record(tmp_path, record)
    loaded = load_record(tmp_path)
    for name in SERIES:
        np.testing.assert_allclose(getattr(loaded, name), getattr(record, name), atol=1e-4)
    for name in EVENTS:
        assert getattr(loaded, name) == getattr(record, name)
    np.testing.assert_array_equal(loaded.grid.cells, record.grid.cells)


@pytest.mark.parametrize("content", ["", "[]", '{"truth": 3}'])
def test_a_broken_record_is_refused_by_name(content, tmp_path):
    (tmp_path / "record.json").write_text(content)
    with pytest.raises(RecordError, match="record.json: not the record of a run"):
        load_record(tmp_path)
    with pytest.raises(RecordError, match="no such file"):
        load_record(tmp_path / "elsewhere")


def test_states_that_end_a_mission_have_the_colours_of_their_meaning():
    names = ["ready", "going to pickup", "picking up", "going to dropoff", "delivered", "setting down"]
    page = timeline([StateEvent(float(stamp), name) for stamp, name in enumerate(names)], 6.0)
    tones = dict(re.findall(r'<li class="(\w+)">([\w ]+) <small>', page))
    assert tones == {
        **{f"tone{number}": name for number, name in enumerate(names[:4])},
        "delivered": "delivered",
        "tone4": "setting down",
    }
    style = report_html({}, RunRecord())
    assert ".delivered { --tone: var(--good); } .failed { --tone: var(--bad); }" in style


def test_the_legend_of_a_long_timeline_lists_each_state_once():
    states = [StateEvent(10.0 * n, ("driving", "docking")[n % 2]) for n in range(50)]
    page = timeline(states, 505.0)
    assert re.findall(r"<li class=.tone\d.>(\w+) <small>([^<]*)", page) == [
        ("driving", "25 x, 250 s"),
        ("docking", "25 x, 255 s"),
    ]
    assert page.count("<i class=") == 50


def test_a_delivery_shows_its_retries_instead_of_the_goals_that_it_needs_anyway(record, result):
    deliveries = [{"name": "tea", "attempts": 2, "retries": 0}, {"name": "cup", "attempts": 5, "retries": 3}]
    text = Page(report_html({**result, "deliveries": deliveries}, record)).text
    assert "nameretriestea0cup3" in text


def test_errors_are_taken_between_poses_of_the_same_moment(record):
    errors = localization_errors(record)
    assert len(errors) == len(record.estimate)
    np.testing.assert_allclose(errors[:, 1], 0.02)
    np.testing.assert_allclose(errors[:, 2], 0.1)
    assert summary(record)["localization_error"] == {"mean": 0.02, "rmse": 0.02, "max": 0.02}
    assert "localization_error" not in summary(RunRecord())


def test_the_real_time_factor_is_that_of_the_last_second(record):
    np.testing.assert_allclose(real_time_factors(record)[5:, 1], 4.0, atol=1e-6)


def test_pictures_show_the_robot_where_it_was(record, result):
    picture = run_picture(result, record, width=400)
    assert picture.width == 400
    frames = list(run_frames(result, record, width=300, count=5))
    assert len(frames) == 5
    blue = [np.argwhere((np.asarray(frame) == (37, 99, 235)).all(axis=2))[:, 1].max() for frame in frames]
    assert blue == sorted(blue) and blue[0] < blue[-1]


def test_a_folder_gets_every_file_and_trajectories_that_other_tools_read(record, result, tmp_path):
    assert write_report(tmp_path, result, record, with_gif=True) == []
    assert sorted(path.name for path in tmp_path.iterdir()) == FILES
    rows = np.loadtxt(tmp_path / "trajectory_estimated.tum")
    assert rows.shape == (41, 8)
    np.testing.assert_allclose(rows[-1, :3], [8.0, 5.0, 1.98])
    with Image.open(tmp_path / "run.gif") as animation:
        assert animation.n_frames > 20


def test_the_page_lists_what_a_full_disk_kept_from_being_written(record, result, tmp_path, monkeypatch):
    def write(path, data):
        if path.suffix != ".html":
            raise FileWriteError(f"{path}: cannot be written (No space left on device)")
        path.write_bytes(data)

    monkeypatch.setattr(writing, "write_atomically", write)
    monkeypatch.setattr("run_report.record.write_atomically", write)
    missing = write_report(tmp_path, result, record)
    assert len(missing) == 5
    assert "run.png: cannot be written (No space left on device)" in missing
    assert "run.png: cannot be written" in Page((tmp_path / "report.html").read_text()).text


@pytest.mark.parametrize(
    "low, high, ticks", [(0.0, 0.023, [0.0, 0.01, 0.02, 0.03]), (-1.8, 1.7, [-2, -1, 0, 1, 2])]
)
def test_ticks_are_round_and_enclose_the_values(low, high, ticks):
    assert nice_ticks(low, high) == pytest.approx(ticks)


def test_every_colour_of_the_page_is_defined(record, result):
    text = report_html(result, record)
    assert set(re.findall(r"var\((--\w+)\)", text)) <= set(re.findall(r"(--\w+):", text))
