"""Rules by which simulated time passes beside other people's nodes: set, known, learned."""

import struct
from pathlib import Path

import pytest

from planar import SettingsError
from sim_bridge.config import BridgeSettings
from sim_bridge.rest.rules import (
    NodeFacts,
    choose_rule,
    parse_rule,
    parse_rules,
    program_of,
    read_known_nodes,
)
from sim_bridge.ros.timing.stamped_messages import stamp_of

KNOWN = read_known_nodes(Path(__file__).resolve().parents[1] / "config" / "known_nodes.yaml")


def test_rules_are_given_by_the_name_of_the_node():
    rules = parse_rules("planner:rest /camera/driver:real_time laser:stamps=scan")
    assert {name: rule.kind for name, rule in rules.items()} == {
        "/planner": "rest",
        "/camera/driver": "real_time",
        "/laser": "stamps",
    }
    assert rules["/laser"].topic == "/scan"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("planner:rset", 'pace: "planner:rset": unknown rule "rset" \\(did you mean "rest"\\?\\)'),
        ("planner", 'pace: "planner" must be NODE:RULE'),
        (":rest", 'pace: ":rest" must be NODE:RULE'),
        ("laser:stamps", 'rule "stamps": expected rest, stamps=TOPIC'),
        ("laser:rest=scan", 'rule "rest=scan": expected'),
        ("planner:rest /planner:observe", "/planner has two rules"),
    ],
)
def test_a_bad_rule_is_named(text, message):
    with pytest.raises(SettingsError, match=message):
        parse_rules(text)
    with pytest.raises(SettingsError, match=message):
        BridgeSettings(world="w", pace=text)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("amcl: {rule: sleep}", ":1: amcl.rule is invalid: unknown rule"),
        ("amcl: {role: rest}", 'unknown key "amcl.role" \\(did you mean "rule"'),
        ("amcl: rest", "amcl must be a table"),
    ],
)
def test_a_bad_file_of_known_nodes_is_named_with_its_line(tmp_path, text, message):
    path = tmp_path / "known.yaml"
    path.write_text(text)
    with pytest.raises(SettingsError, match=message):
        read_known_nodes(path)


def kind(name, program, follows_clock=True, named=""):
    return choose_rule(NodeFacts(name, program, follows_clock), parse_rules(named), KNOWN).kind


def test_the_rule_of_the_name_precedes_that_of_the_program_and_the_learned_one():
    assert kind("/amcl", "amcl", named="amcl:real_time") == "real_time"
    assert kind("/localizer", "amcl") == "rest"
    assert kind("/rviz_2", "rviz", follows_clock=False) == "observe"
    assert kind("/planner", "planner") == "rest"
    assert kind("/driver", "driver", follows_clock=False) == "real_time"
    assert kind("/driver", "driver", follows_clock=False, named="driver:rest") == "rest"
    assert KNOWN["move_base"].keeps == {"/tf", "/odom"}


def test_a_node_on_another_machine_is_paced_by_its_stamps_only():
    assert kind("/amcl", "") == "real_time"
    assert kind("/amcl", "", named="amcl:rest") == "real_time"
    assert kind("/amcl", "", named="amcl:stamps=amcl_pose") == "stamps"


def test_the_sentence_states_the_rule_its_reason_and_how_far_runs_repeat():
    rule = choose_rule(NodeFacts("/planner", "planner", True), {}, KNOWN)
    assert rule.sentence("planner") == (
        "planner: time waits until all its threads rest (rest: learned: it subscribes to /clock); "
        "repeats to the bit unless two of its threads race"
    )
    assert "time waits for its messages on /scan" in parse_rule("stamps=scan", "set").sentence("laser")
    assert "its planner, control loop" in KNOWN["move_base"].sentence("move_base")


@pytest.mark.parametrize(
    ("words", "program"),
    [
        (["/opt/ros/lib/amcl/amcl", "__name:=amcl"], "amcl"),
        (["/usr/bin/python3", "-B", "/home/me/src/follow.py", "__name:=f"], "follow"),
        (["python3"], "python3"),
        ([], ""),
    ],
)
def test_the_program_of_a_node(words, program):
    assert program_of(words) == program


def test_the_stamp_of_a_message_is_read_without_its_type():
    data = struct.pack("<III", 7, 12, 500_000_000) + b"..."
    assert stamp_of(data, "# A pose.\nuint8 ONE=1\nHeader header # frame\nPose pose\n") == 12.5
    assert stamp_of(data, "std_msgs/Header header\nfloat64 x\n") == 12.5
    assert stamp_of(data, "float64 x\nHeader header\n") is None
    assert stamp_of(b"short", "Header header\n") is None
