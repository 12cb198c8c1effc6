"""A checkpoint belongs to the work of the process that left it."""

import pytest
import rospy

from planar import Pose2, SettingsError
from planar_ros.node import checkpoint
from planar_ros.node.checkpoint import FileCheckpoint, ParameterCheckpoint


@pytest.fixture
def parameters(monkeypatch, tmp_path):
    """Parameters of a master by name; warnings are appended to ``parameters["warnings"]``."""
    values = {"warnings": []}

    class Writer:
        def write(self, changes):
            values.update(changes)

    monkeypatch.setattr(checkpoint, "ParameterWriter", Writer)
    monkeypatch.setattr(rospy, "resolve_name", lambda name: name)
    monkeypatch.setattr(rospy, "get_name", lambda: "/node")
    monkeypatch.setattr(rospy, "get_param", values.get)
    monkeypatch.setattr(rospy, "on_shutdown", lambda hook: None)
    monkeypatch.setattr(rospy, "logwarn", lambda text, *given: values["warnings"].append(text % given))
    monkeypatch.setattr(checkpoint.rospkg, "get_log_dir", lambda: str(tmp_path))
    return values


def test_a_process_recovers_what_an_earlier_one_saved_and_never_its_own(parameters):
    before = ParameterCheckpoint()
    before.save([1, 2])
    assert before.recovered(list) is None
    after = ParameterCheckpoint()
    after.save([3])
    assert after.recovered(list) == [1, 2]
    assert not parameters["warnings"]


def test_a_file_is_recovered_by_the_next_process_and_never_by_its_own(parameters):
    before = FileCheckpoint()
    for text in ("first", "second"):
        before.save(lambda path, text=text: path.write_text(text), text)
    assert before.recovered(lambda saved: saved.value) is None
    after = FileCheckpoint()
    assert after.recovered(lambda saved: (saved.path.read_text(), saved.value)) == ("second", "second")


@pytest.mark.parametrize(
    "left", ["{", 7, {"a": 1}, "[" * 100_000, "[1]", '{"x": 1e999, "y": 0, "yaw": 0}', "1"]
)
def test_a_checkpoint_of_another_shape_is_ignored_with_one_warning(parameters, left):
    parameters["~checkpoint/value"] = left
    node = ParameterCheckpoint()
    assert node.recovered(Pose2.from_dict) is None
    assert node.recovered(Pose2.from_dict) is None
    (warning,) = parameters["warnings"]
    assert warning.startswith("ignoring the checkpoint in ~checkpoint/value")
    assert FileCheckpoint().recovered(lambda saved: saved.value) is None


def test_a_checkpoint_that_its_reader_refuses_is_ignored(parameters):
    def refuse(value):
        raise SettingsError("of another version")

    ParameterCheckpoint().save(1)
    assert ParameterCheckpoint().recovered(refuse) is None
    assert "of another version" in parameters["warnings"][0]


def test_a_pose_is_read_from_its_record():
    assert Pose2.from_dict({"x": 1, "y": 2.0, "yaw": 0.5}) == Pose2(1.0, 2.0, 0.5)
