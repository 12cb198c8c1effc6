"""What tools compute."""

import json
import math
import os
import re
from types import SimpleNamespace

import numpy as np
import pytest
from home_service_msgs.msg import Delivery, DeliveryState, MissionState
from nav_msgs.msg import Odometry

from cockpit.errors import CockpitError
from cockpit.frames import Transform
from cockpit.models.bag_files import bags_below, new_bag
from cockpit.models.frame_table import rows_of
from cockpit.models.graph_drawing import ALL, NODES, GraphFilter, dot_of
from cockpit.models.log import MOST_KEPT, MOST_SHOWN, LogBuffer, LogEntry, LogFilter, level_named
from cockpit.models.mission import STATES, mission_html
from cockpit.models.rates import PeriodicTimer
from cockpit.models.reconfigure import ReconfigurableParameter, parameters_from_description, values_of
from cockpit.models.service import service_html
from cockpit.models.tables import table
from cockpit.models.text import amount, flat
from cockpit.models.time_series import TimeSeries, expanded, number_at, numbers_in, suggested

PUBLISHERS = {
    "/scan": ["/sim"],
    "/plan": ["/nav"],
    "/rosout": ["/sim", "/nav"],
    "/nav/goal": ["/errand"],
    "/nav/cancel": ["/errand"],
}
SUBSCRIBERS = {
    "/scan": ["/nav", "/cockpit_1"],
    "/rosout": ["/rosout"],
    "/nav/goal": ["/nav"],
    "/nav/cancel": ["/nav"],
}


def test_the_graph_has_what_is_in_use_and_no_debugging():
    dot = dot_of(PUBLISHERS, SUBSCRIBERS, GraphFilter())
    assert '"n/sim" -> "t/scan";' in dot
    assert '"t/scan" -> "n/nav";' in dot
    assert '"n/errand" -> "t/nav/action";' in dot
    for hidden in ("rosout", "cockpit", "/plan", "/nav/goal"):
        assert hidden not in dot


def test_the_graph_has_all_topics_or_none():
    assert '"n/nav" -> "t/plan";' in dot_of(PUBLISHERS, SUBSCRIBERS, GraphFilter(kind=ALL))
    assert "/rosout" in dot_of(PUBLISHERS, SUBSCRIBERS, GraphFilter(debug=True))
    nodes = dot_of(PUBLISHERS, SUBSCRIBERS, GraphFilter(kind=NODES))
    assert '"n/sim" -> "n/nav" [label="/scan"' in nodes
    assert '"t/' not in nodes


def test_the_graph_is_filtered_by_names_of_nodes_and_topics():
    dot = dot_of(PUBLISHERS, SUBSCRIBERS, GraphFilter(part_of_name="SCAN"))
    assert "/sim" in dot and "/errand" not in dot


def test_a_name_cannot_break_out_of_the_drawing():
    dot = dot_of({'/a"]; evil [': ["/n\\"]}, {'/a"]; evil [': ["/m"]}, GraphFilter())
    assert '/a\\"]; evil [' in dot and '"n/n\\\\"' in dot


def entry(level, text, node="/amcl"):
    return LogEntry(level, 1.0, node, text, "amcl.py:1")


def test_a_log_is_filtered_by_level_node_and_text_the_newest_first():
    log = LogBuffer()
    for line in (
        entry(2, "one"),
        entry(4, "Two"),
        entry(8, "two", "/move_base"),
        entry(1, "two"),
    ):
        log.add(line)
    assert [row[3] for row in log.rows(LogFilter(lowest=2))] == ["two", "Two", "one"]
    assert [row[2] for row in log.rows(LogFilter(text="TWO", lowest=4))] == ["/move_base", "/amcl"]
    assert [row[0] for row in log.rows(LogFilter(node="move"))] == ["Error"]
    assert level_named("Warn") == 4


def test_a_log_has_an_end():
    log = LogBuffer()
    for number in range(MOST_KEPT + 10):
        log.add(entry(2, str(number)))
    rows = log.rows(LogFilter())
    assert len(rows) == MOST_SHOWN
    assert rows[0][3] == str(MOST_KEPT + 9)
    log.clear()
    assert log.rows(LogFilter()) == []


def transform(parent, stamp=0.0, is_static=False):
    return Transform(parent, np.eye(4), stamp, is_static, "/amcl")


def test_the_tree_of_frames_goes_from_the_root_down_with_ages():
    transforms = {
        "odom": transform("map", 9.5),
        "base": transform("odom", 9.9),
        "laser": transform("base", is_static=True),
    }
    rows = rows_of(transforms, 10.0, {"odom": 20.0})
    assert [row[0].strip() for row in rows] == ["map", "odom", "base", "laser"]
    assert rows[1][1:] == ("0.50", "20.0", "/amcl")
    assert rows[3][1] == "static"


def test_frames_in_a_loop_are_listed_as_such():
    rows = rows_of({"a": transform("b"), "b": transform("a")}, 0.0, {})
    assert [row[0] for row in rows] == ["a (in a loop)", "b (in a loop)"]


def message(**fields):
    """As genpy's: its fields are its slots."""
    return type("Message", (), {"__slots__": list(fields), "__init__": _init})(fields)


def _init(self, fields):
    for name, value in fields.items():
        setattr(self, name, value)


MESSAGE = message(
    header=message(stamp=SimpleNamespace(to_sec=lambda: 1.5), frame_id="map"),
    pose=message(position=message(x=2.0)),
    ranges=np.array([1.0, math.nan, 3.0]),
    poses=[message(x=7)],
    is_on=True,
)


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("pose.position.x", 2.0),
        ("ranges[2]", 3.0),
        ("poses[0].x", 7.0),
        ("header.stamp", 1.5),
        ("is_on", 1.0),
    ],
)
def test_a_number_is_found_by_its_path(path, value):
    assert number_at(MESSAGE, path) == value


@pytest.mark.parametrize(
    "path", ["", "pose", "nothing", "ranges[9]", "header.frame_id", "__class__", "pose..x"]
)
def test_a_field_that_is_no_number_is_an_error(path):
    with pytest.raises(CockpitError):
        number_at(MESSAGE, path)


def test_words_of_rqt_plot_may_be_several_numbers():
    assert expanded("/a/x:y:z") == ["/a/x", "/a/y", "/a/z"]
    assert expanded("/a/x,/b/data") == ["/a/x", "/b/data"]
    assert expanded("") == []


def test_the_numbers_of_a_message_are_listed():
    listed = numbers_in(MESSAGE)
    assert {"pose.position.x", "ranges[0]", "poses[0].x", "header.stamp", "is_on"} <= set(listed)
    assert "header.frame_id" not in listed


def test_numbers_are_suggested_by_topic_without_those_of_headers():
    numbers = {"/odom": numbers_in(Odometry()), "/go": ["data"]}
    assert numbers["/odom"][0] == "pose.pose.position.x"
    assert numbers["/odom"][-1] == "header.stamp"
    found = suggested(numbers)
    assert {("/odom", "twist.twist.linear.x"), ("/go", "data")} <= set(found)
    assert not [path for _, path in found if path.startswith("header")]


def test_traces_hold_each_number_until_the_next_and_leave_out_what_is_none():
    traces = TimeSeries(seconds=10.0)
    for at, value in ((0.0, 5.0), (91.0, 1.0), (95.0, 2.0), (96.0, math.nan)):
        traces.add("a", at, value)
    traces.add("b", 93.0, 7.0)
    times, a, b = traces.drawn(["a", "b"], 100.0)
    assert times.tolist() == [-9.0, -7.0, -5.0, 0.0]
    assert a.tolist() == [1.0, 1.0, 2.0, 2.0]
    assert b.tolist() == [7.0, 7.0, 7.0, 7.0]
    assert traces.newest("a") == 2.0 and math.isnan(traces.newest("c"))


def test_many_samples_are_thinned():
    traces = TimeSeries(seconds=1000.0)
    for number in range(5000):
        traces.add("a", float(number) / 10.0, 1.0)
    times, values = traces.drawn(["a"], 500.0)
    assert len(times) == len(values) <= 1000
    assert times[-1] == 0.0


def parameter_message(name, kind, edit_method=""):
    return SimpleNamespace(name=name, type=kind, description="what it does", edit_method=edit_method)


def config(**doubles):
    found = [SimpleNamespace(name=name, value=value) for name, value in doubles.items()]
    return SimpleNamespace(bools=[], ints=[], strs=[], doubles=found)


def test_parameters_have_the_bounds_published_by_the_server():
    group = SimpleNamespace(
        parameters=[parameter_message("speed", "double"), parameter_message("far", "double")]
    )
    description = SimpleNamespace(
        groups=[group],
        min=config(speed=0.0, far=-math.inf),
        max=config(speed=2.0, far=math.inf),
        dflt=config(speed=0.5, far=1.0),
    )
    speed, far = parameters_from_description(description)
    assert (speed.lowest, speed.highest, speed.default, speed.is_bounded) == (0.0, 2.0, 0.5, True)
    assert not far.is_bounded
    assert values_of(config(speed=1.0)) == {"speed": 1.0}


def test_choices_are_read_and_nonsense_is_none():
    listed = "{'enum': [{'name': 'Slow', 'value': 0, 'type': 'int'}], 'enum_description': ''}"
    for text, choices in ((listed, (("Slow", 0),)), ("__import__('os')", ()), ("[[", ()), ("3", ())):
        group = SimpleNamespace(parameters=[parameter_message("mode", "double", text)])
        values = config(mode=0.0)
        (parameter,) = parameters_from_description(
            SimpleNamespace(groups=[group], min=values, max=values, dflt=values)
        )
        assert parameter.choices == choices


@pytest.mark.parametrize(
    ("kind", "highest", "step"),
    [("int", 50, 1), ("double", 5.0, 0.001), ("double", 500.0, 0.1), ("double", math.inf, 0.01)],
)
def test_sliders_are_as_fine_as_makes_sense(kind, highest, step):
    assert ReconfigurableParameter("a", kind, 0, highest, 1).step == step


def test_what_is_repeated_is_due_at_its_rate_and_makes_up_for_nothing():
    repeating = PeriodicTimer()
    assert not repeating.is_due(0.0)
    repeating.start(1.0, 0.5)
    assert [repeating.is_due(at) for at in (1.0, 1.2, 1.5, 1.6)] == [True, False, True, False]
    assert [repeating.is_due(at) for at in (9.0, 9.01, 9.6)] == [True, True, True]
    repeating.stop()
    assert not repeating.is_due(20.0)


def test_recordings_go_into_the_folder_and_nowhere_else(tmp_path):
    assert new_bag(tmp_path, "one") == new_bag(tmp_path, "one.bag") == tmp_path / "one.bag"
    (tmp_path / "one.bag").touch()
    for name in ("one", "", "../one", "/tmp/one", ".hidden", "a b", "x" * 200):
        with pytest.raises(CockpitError):
            new_bag(tmp_path, name)


def test_bags_are_found_the_newest_first(tmp_path):
    inside = tmp_path / "runs/a/bag/run.bag"
    inside.parent.mkdir(parents=True)
    for number, path in enumerate((tmp_path / "old.bag", inside)):
        path.touch()
        os.utime(path, (number, number))
    assert bags_below(tmp_path) == ["runs/a/bag/run.bag", "old.bag"]


def test_parameters_are_flattened():
    assert flat({"a": {"b": 1, "c": {}}, "d": [1]}) == {"/a/b": 1, "/a/c": {}, "/d": [1]}
    assert flat({}) == {}


def test_amounts_are_formatted_in_short_units():
    assert (amount(1500), amount(2_500_000)) == ("1.5 KB", "2.5 MB")


def test_a_mission_lists_its_deliveries():
    state = MissionState(mission="<tea>", state="carrying", progress=0.5, time_left=12.0)
    what = Delivery(object="cup", source="kitchen", destination="context")
    state.deliveries = [DeliveryState(delivery=what, state=each) for each in (DeliveryState.CARRYING, 99)]
    html = mission_html(state)
    for text in (
        "&lt;tea&gt;: carrying",
        "50 %",
        "12 s left",
        "cup",
        "kitchen",
        "context",
        ">carrying<",
        ">99<",
    ):
        assert text in html


def test_the_states_of_deliveries_have_the_names_of_their_message():
    for number, name in enumerate(STATES):
        assert getattr(DeliveryState, name.upper().replace(" ", "_")) == number


def test_nothing_in_a_table_is_html():
    assert "<script>" not in table(("A",), [("<script>",), ("<script>" * 20,)])


def test_names_in_a_table_are_never_broken_and_texts_between_words():
    name = "/move_base/DWAPlannerROS/trajectory_samples/critics/of/one"
    drawn = table(("Name", "Text"), [(name, "two words " * 6)])
    of_name, of_text = (style for style in re.findall(r'<td style="([^"]*)"', drawn))
    assert "white-space:nowrap" in of_name
    assert "overflow-wrap:break-word" in of_text and "anywhere" not in drawn


def service_state(tasks=(), **state):
    state = {
        "activity": "idle",
        "carrying": None,
        "charge": 0.5,
        "is_docked": False,
        "open": len(tasks),
        **state,
    }
    return json.dumps({"state": state, "tasks": list(tasks)})


def test_the_queue_of_a_service_is_listed_with_its_battery():
    tasks = [
        {"text": "deliver <cup> from kitchen to desk", "status": "underway", "in_time": False},
        {"text": "dock", "status": "queued", "reason": "to charge", "unix_millis_expected_finish_time": 0},
    ]
    drawn = service_html(service_state(tasks, activity="driving to kitchen", carrying="cup", open=5))
    for text in (
        "50 %",
        "<b>driving to kitchen</b>, carrying cup",
        "&lt;cup&gt;",
        "late",
        "to charge",
        "3 more",
    ):
        assert text in drawn
    assert "width:50%" in drawn and "in the dock" not in drawn


def test_a_service_without_requests_or_battery_is_described():
    assert "no requests" in service_html(service_state(is_docked=True)) and "in the dock" in service_html(
        service_state(is_docked=True)
    )
    assert "no battery state" in service_html(service_state(charge=None))


@pytest.mark.parametrize(
    "text", ["", "{", "[]", "{}", '{"state": {}, "tasks": []}', '{"state": 1, "tasks": 2}']
)
def test_a_malformed_state_of_a_service_is_an_error(text):
    with pytest.raises(CockpitError, match="service/state"):
        service_html(text)
